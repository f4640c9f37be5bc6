// The mirror kernel compiled for each vector target, and which problems it steps, and how.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/rings/mirror.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cstdint>

#include "kernels/rings/mirror.hpp"
#include "kernels/rings/mirror_stepper-inl.hpp"
#include "kernels/rings/ring_forms-inl.hpp"
#include "kernels/rings/ring_forms.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<double>;

std::unique_ptr<Stepper> make_mirror(const Problem& problem, const RingShape& shape,
                                     std::int64_t sum, int threads) {
  return with_ring_form(
      law_form(problem.law), shape.rings, [&]<class Law, int R>() -> std::unique_ptr<Stepper> {
        return std::make_unique<MirrorStepper<D, Law, R>>(problem, shape, sum, threads);
      });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

constexpr std::int64_t fewest_columns = 3;  // of a thread: RingTeam<Columns, MirrorHalf> says so

Preparation prepare_mirror(const Problem& problem, const KernelRequest& request,
                           const PrepareInside&) {
  const RingForm form = find_ring_form(problem);
  if (!form.refusal.empty()) return Refusal{form.refusal};
  const RingShape& shape = form.shape;
  const MirrorAxis axis = find_mirror_axis(problem, shape);
  if (!axis.refusal.empty()) {
    return Refusal{"it is not left-right symmetric: " + axis.refusal};
  }
  const std::int64_t half = shape.per_ring / 2;
  Plan plan = plan_for(problem);
  if (std::string why = deal_columns(half, 2, false, request, plan); !why.empty()) {
    return Refusal{why};
  }
  const std::int64_t columns = half / plan.lanes + 1;
  deal_threads(columns, fewest_columns, request, team_size(columns), plan);
  plan.multiplications = ring_multiplications(problem, shape.rings, columns);
  describe_rings("the ball, its walls and gravity are left-right symmetric: half of it is stepped",
                 plan);
  plan.left_out.emplace_back("the other half of the ball");
  plan.make_stepper = [&problem, shape, sum = axis.sum,
                       make = BOUNCE_COMPILED_FOR(plan.vector, make_mirror),
                       threads = plan.threads] { return make(problem, shape, sum, threads); };
  return plan;
}

}  // namespace

KernelEntry mirror_entry() {
  return {.name = "mirror",
          .description = "half of a left-right symmetric ball of rings",
          .memory = {.a_particle = 32.0, .an_entry = 0.0},
          .prepare = prepare_mirror};
}

}  // namespace bounce
#endif
