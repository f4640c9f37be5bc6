// Instantiates the csr kernel for each vector target; csr_physics-inl.hpp says how it works.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/csr/csr.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/csr/csr.hpp"
#include "kernels/csr/csr_physics-inl.hpp"
#include "kernels/stepping/scene_forms.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<double>;

template <class Law>
std::unique_ptr<Stepper> csr_of(const Problem& problem, const Plan& plan) {
  return std::make_unique<SlicedStepper<FastPhysics<D, Law>>>(problem, plan.threads);
}

std::unique_ptr<Stepper> make_csr(const Problem& problem, const Plan& plan) {
  switch (law_form(problem.law)) {
    case LawForm::three_five:
      return csr_of<FixedLaw<4, 2>>(problem, plan);
    case LawForm::seven_thirteen:
      return csr_of<FixedLaw<8, 6>>(problem, plan);
    case LawForm::two_four:
      return csr_of<FixedLaw<3, 2>>(problem, plan);
    case LawForm::odd:
      return csr_of<OddLaw>(problem, plan);
    case LawForm::general:
      break;
  }
  return csr_of<GeneralLaw>(problem, plan);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

std::string prepare_csr(const Problem& problem, const PlanRequest& request, Plan& plan) {
  plan.lanes = plan.vector == VectorTarget::avx512 ? 8 : 4;
  const bool large = problem.initial.size() >= particles_worth_a_team;
  plan.threads = request.threads != 0 ? request.threads : large ? omp_get_max_threads() : 1;
  plan.reasons.emplace_back("csr runs any neighbour list, law and walls");
  return {};
}

std::unique_ptr<Stepper> make(const Problem& problem, const Plan& plan) {
  return plan.vector == VectorTarget::avx512 ? N_AVX3::make_csr(problem, plan)
                                             : N_AVX2::make_csr(problem, plan);
}

}  // namespace

KernelEntry csr_entry() {
  return {.name = "csr",
          .description = "any neighbour list, any law, any walls; threads over particles",
          .automatic = true,
          .memory = sliced_memory,
          .prepare = prepare_csr,
          .make = make};
}

}  // namespace bounce
#endif
