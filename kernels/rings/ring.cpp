// The ring kernel compiled for each vector target, and which problems it steps, and how.
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

std::unique_ptr<Stepper> make_ring(const Problem& problem, const RingShape& shape, int threads) {
  return with_ring_form(law_form(problem.law), shape.rings,
                        [&]<class Law, int R>() -> std::unique_ptr<Stepper> {
                          return std::make_unique<RingStepper<D, Law, R>>(problem, shape, threads);
                        });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

constexpr std::int64_t fewest_columns = 2;  // of a thread

Preparation prepare_ring(const Problem& problem, const KernelRequest& request,
                         const PrepareInside&) {
  const RingForm form = find_ring_form(problem);
  if (!form.refusal.empty()) return Refusal{form.refusal};
  const RingShape& shape = form.shape;
  Plan plan = plan_for(problem);
  if (std::string why = deal_columns(shape.per_ring, 2, true, request, plan); !why.empty()) {
    return Refusal{why};
  }
  const std::int64_t columns = shape.per_ring / plan.lanes;
  deal_threads(columns, fewest_columns, request, team_size(columns), plan);
  plan.multiplications = ring_multiplications(problem, shape.rings, columns);
  describe_rings(
      "the neighbour list is " + std::to_string(shape.rings) + " rings with constant offsets",
      plan);
  plan.make_stepper = [&problem, shape, make = BOUNCE_COMPILED_FOR(plan.vector, make_ring),
                       threads = plan.threads] { return make(problem, shape, threads); };
  return plan;
}

}  // namespace

KernelEntry ring_entry() {
  return {.name = "ring",
          .description = "rings with constant offsets: each bond once, no index",
          .memory = {.a_particle = 32.0, .an_entry = 0.0},
          .prepare = prepare_ring};
}

}  // namespace bounce
#endif
