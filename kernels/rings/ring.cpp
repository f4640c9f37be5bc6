// Instantiates the ring kernel for each vector target and picks the one a plan names.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/rings/ring.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/rings/ring.hpp"
#include "kernels/rings/ring_forms-inl.hpp"
#include "kernels/rings/ring_forms.hpp"
#include "kernels/rings/ring_stepper-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

// One number of lanes a target: the widest it has.
using D = hn::ScalableTag<double>;

std::unique_ptr<Stepper> make_ring(const Problem& problem, const RingShape& shape,
                                   const Plan& plan) {
  return with_ring_form(
      law_form(problem.law), shape.rings, [&]<class Law, int R>() -> std::unique_ptr<Stepper> {
        return std::make_unique<RingStepper<D, Law, R>>(problem, shape, plan.threads);
      });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

std::string prepare_ring(const Problem& problem, const PlanRequest& request, Plan& plan) {
  const RingForm form = find_ring_form(problem);
  if (!form.refusal.empty()) return form.refusal;
  const RingShape& shape = form.shape;
  plan.lanes = ring_lanes(shape.per_ring, plan.vector);
  if (plan.lanes == 0) {
    return std::to_string(shape.per_ring) + " columns cannot be dealt evenly to 4 lanes";
  }
  const std::int64_t columns = shape.per_ring / plan.lanes;
  plan.threads = team_size(request.threads, columns);
  if (plan.threads > 1 && plan.threads > columns / 2) {
    return std::to_string(plan.threads) + " threads are too many for its " +
           std::to_string(columns) + " columns of vectors: a thread needs two";
  }
  plan.multiplications = ring_multiplications(problem, shape.rings, columns);
  plan.reasons.push_back("the neighbour list is " + std::to_string(shape.rings) +
                         " rings with constant offsets: each bond once, no index, " +
                         std::to_string(plan.lanes) + " sectors side by side");
  plan.left_out.emplace_back("neighbour index and gathers");
  plan.left_out.emplace_back("the second computation of each bond");
  return {};
}

std::unique_ptr<Stepper> make(const Problem& problem, const Plan& plan) {
  const auto shape = find_rings(problem.bonds);
  if (!shape) return nullptr;
  return plan.lanes == 8 ? N_AVX3::make_ring(problem, *shape, plan)
                         : N_AVX2::make_ring(problem, *shape, plan);
}

}  // namespace

KernelEntry ring_entry() {
  return {.name = "ring",
          .description = "rings with constant offsets: each bond once, no index",
          .automatic = true,
          .memory = {.a_particle = 32.0, .an_entry = 0.0},
          .prepare = prepare_ring,
          .make = make};
}

}  // namespace bounce
#endif
