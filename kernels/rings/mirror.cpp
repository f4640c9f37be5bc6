// Instantiates the mirror kernel for each vector target and picks the one a plan names.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/rings/mirror.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
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
                                     std::int64_t sum, const Plan& plan) {
  return with_ring_form(
      law_form(problem.law), shape.rings, [&]<class Law, int R>() -> std::unique_ptr<Stepper> {
        return std::make_unique<MirrorStepper<D, Law, R>>(problem, shape, sum, plan.threads);
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

std::string prepare_mirror(const Problem& problem, const PlanRequest& request, Plan& plan) {
  const RingForm form = find_ring_form(problem);
  if (!form.refusal.empty()) return form.refusal;
  const MirrorAxis axis = find_mirror_axis(problem, form.shape);
  if (!axis.refusal.empty()) return "it is not left-right symmetric: " + axis.refusal;
  const std::int64_t half = form.shape.per_ring / 2;
  plan.lanes = plan.vector == VectorTarget::avx512 && half >= 2 * 8 ? 8 : 4;
  if (half < std::int64_t{2} * plan.lanes) {
    return std::to_string(half) + " columns of half a ball are less than two a lane";
  }
  const std::int64_t columns = half / plan.lanes + 1;
  plan.threads = team_size(request.threads, columns);
  if (const std::int64_t most = columns / fewest_columns; plan.threads > most) {
    plan.threads = static_cast<int>(std::max<std::int64_t>(1, most));
    plan.reasons.emplace_back(std::to_string(columns) + " columns of vectors are enough for " +
                              std::to_string(plan.threads) + " threads: a thread needs three");
  }
  plan.multiplications = ring_multiplications(problem, form.shape.rings, columns);
  plan.reasons.emplace_back(
      "the ball, its walls and gravity are left-right symmetric: half of it "
      "is stepped, each bond once, no index, " +
      std::to_string(plan.lanes) + " sectors side by side");
  plan.left_out.emplace_back("neighbour index and gathers");
  plan.left_out.emplace_back("the second computation of each bond");
  plan.left_out.emplace_back("the other half of the ball");
  return {};
}

std::unique_ptr<Stepper> make(const Problem& problem, const Plan& plan) {
  const RingForm form = find_ring_form(problem);
  const std::int64_t sum = find_mirror_axis(problem, form.shape).sum;
  return plan.lanes == 8 ? N_AVX3::make_mirror(problem, form.shape, sum, plan)
                         : N_AVX2::make_mirror(problem, form.shape, sum, plan);
}

}  // namespace

KernelEntry mirror_entry() {
  return {.name = "mirror",
          .description = "half of a left-right symmetric ball of rings",
          .automatic = true,
          .memory = {.a_particle = 32.0, .an_entry = 0.0},
          .prepare = prepare_mirror,
          .make = make};
}

}  // namespace bounce
#endif
