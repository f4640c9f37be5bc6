// The annulus kernel compiled for each vector target, and which problems it steps, and how.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/rings/annulus.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/rings/annulus.hpp"
#include "kernels/rings/annulus_stepper-inl.hpp"
#include "kernels/rings/ring_forms-inl.hpp"
#include "kernels/rings/ring_forms.hpp"
#include "kernels/stepping/threads.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

template <class Law>
std::unique_ptr<Stepper> annulus_of(const Problem& problem, const RingShape& shape, int threads) {
  return std::make_unique<AnnulusStepper<hn::ScalableTag<double>, Law>>(problem, shape, threads);
}

std::unique_ptr<Stepper> make_annulus(const Problem& problem, const RingShape& shape, int threads) {
  switch (law_form(problem.law)) {
    case LawForm::seven_thirteen:
      return annulus_of<FixedLaw<8, 6>>(problem, shape, threads);
    case LawForm::two_four:
      return annulus_of<FixedLaw<3, 2>>(problem, shape, threads);
    default:
      return annulus_of<FixedLaw<4, 2>>(problem, shape, threads);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

Preparation prepare_annulus(const Problem& problem, const KernelRequest& request,
                            const PrepareInside&) {
  const auto shape = find_rings(problem.bonds, any_rings);
  if (!shape) return Refusal{"the neighbour list is not concentric rings with constant offsets"};
  if (shape->rings < 2) return Refusal{"a single ring has no bonds outwards"};
  if (!has_ring_law(law_form(problem.law))) {
    return Refusal{"its exponents (p, q) are not one of (3, 5), (7, 13), (2, 4)"};
  }
  Plan plan = plan_for(problem);
  if (std::string why = deal_columns(shape->per_ring, 2, true, request, plan); !why.empty()) {
    return Refusal{why};
  }
  const std::int64_t columns = shape->per_ring / plan.lanes;
  const bool large = problem.initial.size() >= particles_worth_a_team;
  deal_threads(columns, 1, request, large ? default_threads() : 1, plan);
  plan.multiplications = annulus_multiplications(problem, shape->rings, columns);
  describe_rings(
      "the neighbour list is " + std::to_string(shape->rings) + " rings with constant offsets",
      plan);
  plan.make_stepper = [&problem, shape = *shape,
                       make = BOUNCE_COMPILED_FOR(plan.vector, make_annulus),
                       threads = plan.threads] { return make(problem, shape, threads); };
  return plan;
}

}  // namespace

KernelEntry annulus_entry() {
  return {.name = "annulus",
          .description = "any number of rings: each bond once, no index, ring by ring",
          .memory = {.a_particle = 32.0, .an_entry = 0.0},
          .prepare = prepare_annulus};
}

}  // namespace bounce
#endif
