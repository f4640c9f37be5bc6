// The csr kernel compiled for each vector target, and its plan; csr_physics-inl.hpp says how it
// works.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/csr/csr.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/csr/csr.hpp"
#include "kernels/csr/csr_physics-inl.hpp"
#include "kernels/stepping/law_form.hpp"
#include "kernels/stepping/threads.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<double>;

template <class Law>
std::unique_ptr<Stepper> csr_of(const Problem& problem, int threads) {
  return std::make_unique<SlicedStepper<FastPhysics<D, Law>>>(problem, threads);
}

std::unique_ptr<Stepper> make_csr(const Problem& problem, int threads) {
  switch (law_form(problem.law)) {
    case LawForm::three_five:
      return csr_of<FixedLaw<4, 2>>(problem, threads);
    case LawForm::seven_thirteen:
      return csr_of<FixedLaw<8, 6>>(problem, threads);
    case LawForm::two_four:
      return csr_of<FixedLaw<3, 2>>(problem, threads);
    case LawForm::odd:
      return csr_of<OddLaw>(problem, threads);
    case LawForm::general:
      break;
  }
  return csr_of<GeneralLaw>(problem, threads);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

Preparation prepare_csr(const Problem& problem, const KernelRequest& request,
                        const PrepareInside&) {
  Plan plan = plan_for(problem);
  plan.vector = request.vector;
  plan.lanes = lanes_of(plan.vector);
  const bool large = problem.initial.size() >= particles_worth_a_team;
  plan.threads = request.threads != 0 ? request.threads : large ? default_threads() : 1;
  plan.reasons.emplace_back("csr runs any neighbour list, law and walls");
  plan.make_stepper = [&problem, make = BOUNCE_COMPILED_FOR(plan.vector, make_csr),
                       threads = plan.threads] { return make(problem, threads); };
  return plan;
}

}  // namespace

KernelEntry csr_entry() {
  return {.name = "csr",
          .description = "any neighbour list, any law, any walls; threads over particles",
          .memory = sliced_memory,
          .prepare = prepare_csr};
}

}  // namespace bounce
#endif
