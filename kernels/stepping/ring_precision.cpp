// Instantiates ring with low parts for each vector target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/stepping/ring_precision.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/stepping/ring_forms.hpp"
#include "kernels/stepping/ring_precision-inl.hpp"
#include "kernels/stepping/ring_precision.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

std::unique_ptr<Stepper> make_precision(const Problem& problem, const RingShape& shape,
                                        const Plan& plan) {
  using Doubles = hn::ScalableTag<double>;
  using Floats = hn::CappedTag<float, 8>;
  if (problem.precision == Precision::single_precision) {
    return std::make_unique<PrecisionStepper<Floats>>(problem, shape, plan.free_flight);
  }
  return std::make_unique<PrecisionStepper<Doubles>>(problem, shape, plan.free_flight);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {

std::string prepare_ring_precision(const Problem& problem, const RingShape& shape,
                                   const PlanRequest& request, Plan& plan) {
  const bool single = problem.precision == Precision::single_precision;
  if (law_form(problem.law) != LawForm::three_five || shape.rings != 3) {
    return "precisions other than double are compiled for three rings and exponents (3, 5) only";
  }
  if (request.threads > 1) return "precisions other than double run on one thread";
  if (single && wall_form(problem) == WallForm::any) {
    return "in single precision a wall must be one floor with normal (0, 1): others round a "
           "position by 5e-7 cm at each contact";
  }
  if (single && any_resolved(problem.walls)) {
    return "in single precision a particle at rest on a wall is not told from one in motion, which "
           "contact = \"resolved\" needs";
  }
  plan.lanes = single ? (shape.per_ring % 8 == 0 && shape.per_ring >= 16 ? 8 : 0)
                      : ring_lanes(shape.per_ring, plan.vector);
  if (plan.lanes == 0) {
    return std::to_string(shape.per_ring) + " columns cannot be dealt evenly to " +
           (single ? "8" : "4") + " lanes";
  }
  plan.threads = 1;
  if (!single) leave_out_free_flight(problem, request, plan);
  plan.reasons.push_back("three rings with constant offsets, the only kernel for this precision: " +
                         std::to_string(plan.lanes) + " sectors side by side");
  plan.left_out.emplace_back("neighbour index and gathers");
  plan.left_out.emplace_back("the second computation of each bond");
  return {};
}

std::unique_ptr<Stepper> make_ring_precision(const Problem& problem, const RingShape& shape,
                                             const Plan& plan) {
  // Eight lanes are whole vectors of AVX-512 in double precision, of AVX2 in single.
  const bool single = problem.precision == Precision::single_precision;
  const bool wide = plan.vector == VectorTarget::avx512 && (single || plan.lanes == 8);
  return wide ? N_AVX3::make_precision(problem, shape, plan)
              : N_AVX2::make_precision(problem, shape, plan);
}

}  // namespace bounce
#endif
