// Instantiates the rings kernel for each vector target and picks the one a plan names.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/rings/rings.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/rings/ring_forms-inl.hpp"
#include "kernels/rings/ring_forms.hpp"
#include "kernels/rings/rings.hpp"
#include "kernels/rings/rings_stepper-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

template <class Law>
std::unique_ptr<Stepper> rings_of(const Problem& problem, const RingShape& shape, int threads) {
  return std::make_unique<RingsStepper<hn::ScalableTag<double>, Law>>(problem, shape, threads);
}

std::unique_ptr<Stepper> make_rings(const Problem& problem, const RingShape& shape, int threads) {
  switch (law_form(problem.law)) {
    case LawForm::seven_thirteen:
      return rings_of<FixedLaw<8, 6>>(problem, shape, threads);
    case LawForm::two_four:
      return rings_of<FixedLaw<3, 2>>(problem, shape, threads);
    default:
      return rings_of<FixedLaw<4, 2>>(problem, shape, threads);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

std::string prepare_rings(const Problem& problem, const PlanRequest& request, Plan& plan) {
  const auto shape = find_rings(problem.bonds, any_rings);
  if (!shape) return "the neighbour list is not concentric rings with constant offsets";
  if (shape->rings < 2) return "a single ring has no bonds outwards";
  if (!has_ring_law(law_form(problem.law))) {
    return "its exponents (p, q) are not one of (3, 5), (7, 13), (2, 4)";
  }
  plan.lanes = ring_lanes(shape->per_ring, plan.vector);
  if (plan.lanes == 0) {
    return std::to_string(shape->per_ring) + " columns cannot be dealt evenly to 4 lanes";
  }
  const std::int64_t columns = shape->per_ring / plan.lanes;
  const bool large = problem.initial.size() >= particles_worth_a_team;
  plan.threads = request.threads != 0 ? request.threads
                 : large ? static_cast<int>(std::min<std::int64_t>(omp_get_max_threads(), columns))
                         : 1;
  if (plan.threads > columns) {
    return std::to_string(plan.threads) + " threads are too many for its " +
           std::to_string(columns) + " columns of vectors";
  }
  plan.multiplications = rings_multiplications(problem, shape->rings, columns);
  plan.reasons.push_back("the neighbour list is " + std::to_string(shape->rings) +
                         " rings with constant offsets: each bond once, no index, " +
                         std::to_string(plan.lanes) + " sectors side by side");
  plan.left_out.emplace_back("neighbour index and gathers");
  plan.left_out.emplace_back("the second computation of each bond");
  return {};
}

std::unique_ptr<Stepper> make(const Problem& problem, const Plan& plan) {
  const auto shape = find_rings(problem.bonds, any_rings);
  if (!shape) return nullptr;
  return plan.lanes == 8 ? N_AVX3::make_rings(problem, *shape, plan.threads)
                         : N_AVX2::make_rings(problem, *shape, plan.threads);
}

}  // namespace

KernelEntry rings_entry() {
  return {.name = "rings",
          .description = "any number of rings: each bond once, no index, ring by ring",
          .automatic = true,
          .memory = {.a_particle = 32.0, .an_entry = 0.0},
          .prepare = prepare_rings,
          .make = make};
}

}  // namespace bounce
#endif
