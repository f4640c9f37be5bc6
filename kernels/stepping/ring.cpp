// Instantiates the ring kernel for each vector target and picks the one a plan names.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/stepping/ring.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/stepping/ring.hpp"
#include "kernels/stepping/ring_stepper-inl.hpp"
#include "kernels/stepping/scene_forms.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

// One number of lanes a target: the widest it has.
using D = hn::ScalableTag<double>;

template <class Law, class Walls, int R>
std::unique_ptr<Stepper> ring_of(const Problem& problem, const RingShape& shape, int threads) {
  return std::make_unique<RingStepper<D, Law, Walls, R>>(problem, shape, threads);
}

template <class Law, int R>
std::unique_ptr<Stepper> ring_of(const Problem& problem, const RingShape& shape, int threads) {
  switch (wall_form(problem)) {
    case WallForm::none:
      return ring_of<Law, NoWalls, R>(problem, shape, threads);
    case WallForm::floor:
      return ring_of<Law, Floor, R>(problem, shape, threads);
    case WallForm::any:
      return ring_of<Law, AnyWalls, R>(problem, shape, threads);
  }
  return nullptr;
}

// prepare_ring lets through what stands here: (3, 5) on any of the rings, the others on three.
std::unique_ptr<Stepper> make_ring(const Problem& problem, const RingShape& shape, int threads) {
  const LawForm law = law_form(problem.law);
  if (law == LawForm::seven_thirteen) return ring_of<FixedLaw<8, 6>, 3>(problem, shape, threads);
  if (law == LawForm::two_four) return ring_of<FixedLaw<3, 2>, 3>(problem, shape, threads);
  switch (shape.rings) {
    case 1:
      return ring_of<FixedLaw<4, 2>, 1>(problem, shape, threads);
    case 2:
      return ring_of<FixedLaw<4, 2>, 2>(problem, shape, threads);
    case 3:
      return ring_of<FixedLaw<4, 2>, 3>(problem, shape, threads);
    case 4:
      return ring_of<FixedLaw<4, 2>, 4>(problem, shape, threads);
    default:
      return nullptr;
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

// The widest target whose lanes the columns can be dealt to evenly, two columns a lane at least.
int lanes_for(std::int64_t per_ring, VectorTarget target) {
  const auto fits = [per_ring](int lanes) {
    return per_ring % lanes == 0 && per_ring / lanes >= 2;
  };
  if (target == VectorTarget::avx512 && fits(8)) return 8;
  return fits(4) ? 4 : 0;
}

std::string refuses_law(LawForm form, int rings) {
  if (form == LawForm::three_five) return {};
  const bool known = form == LawForm::seven_thirteen || form == LawForm::two_four;
  if (known && rings == 3) return {};
  return known ? "exponents other than (3, 5) are compiled for three rings only"
               : "its exponents (p, q) are not one of (3, 5), (7, 13), (2, 4)";
}

std::string prepare_ring(const Problem& problem, const PlanRequest& request, Plan& plan) {
  const auto shape = find_rings(problem.bonds);
  if (!shape) {
    return "the neighbour list is not 1 to " + std::to_string(most_rings) +
           " concentric rings with constant offsets";
  }
  if (std::string refusal = refuses_law(law_form(problem.law), shape->rings); !refusal.empty()) {
    return refusal;
  }
  plan.lanes = lanes_for(shape->per_ring, plan.vector);
  if (plan.lanes == 0) {
    return std::to_string(shape->per_ring) + " columns cannot be dealt evenly to 4 lanes";
  }
  plan.threads = request.threads == 0 ? 1 : request.threads;
  const std::int64_t most = shape->per_ring / plan.lanes;
  if (plan.threads > most) {
    return std::to_string(plan.threads) + " threads are more than its " + std::to_string(most) +
           " columns of vectors";
  }
  plan.reasons.push_back("the neighbour list is " + std::to_string(shape->rings) +
                         " rings with constant offsets: each bond once, no index, " +
                         std::to_string(plan.lanes) + " sectors side by side");
  plan.left_out.emplace_back("neighbour index and gathers");
  plan.left_out.emplace_back("the second computation of each bond");
  return {};
}

std::unique_ptr<Stepper> make(const Problem& problem, const Plan& plan) {
  const auto shape = find_rings(problem.bonds);
  if (!shape) return nullptr;
  return plan.lanes == 8 ? N_AVX3::make_ring(problem, *shape, plan.threads)
                         : N_AVX2::make_ring(problem, *shape, plan.threads);
}

}  // namespace

KernelEntry ring_entry() {
  return {.name = "ring",
          .description = "rings with constant offsets: each bond once, no index",
          .automatic = true,
          .prepare = prepare_ring,
          .make = make};
}

}  // namespace bounce
#endif
