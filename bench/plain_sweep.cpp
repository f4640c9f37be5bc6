#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/plain_sweep.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "bench/plain_sweep.hpp"
#include "kernels/rings/ring_stepper-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

std::unique_ptr<Stepper> make_sweep(const Problem& problem, const RingShape& shape, int threads) {
  using Sweep = RingStepper<hn::ScalableTag<double>, FixedLaw<4, 2>, 3>;
  return std::make_unique<Sweep>(problem, shape, threads, 1);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {

std::unique_ptr<Stepper> make_plain_sweep(const Problem& problem, VectorTarget vector,
                                          int threads) {
  const RingShape shape = find_rings(problem.bonds).value();
  return BOUNCE_COMPILED_FOR(vector, make_sweep)(problem, shape, threads);
}

}  // namespace bounce
#endif
