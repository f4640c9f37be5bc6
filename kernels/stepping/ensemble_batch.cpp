// Instantiates the ensemble's batches for each vector target and picks the one that is asked for.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/stepping/ensemble_batch.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/stepping/ensemble_batch-inl.hpp"
#include "kernels/stepping/ensemble_batch.hpp"
#include "kernels/stepping/ring_forms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

std::unique_ptr<EnsembleBatch> make_ring_batch(const BatchForm& form) {
  using D = hn::ScalableTag<double>;
  return with_ring_form(law_form(form.law), form.shape.rings,
                        [&]<class Law, int R>() -> std::unique_ptr<EnsembleBatch> {
                          if (form.floors_only) {
                            return std::make_unique<RingBatch<D, Law, LaneFloors<D>, R>>(form);
                          }
                          return std::make_unique<RingBatch<D, Law, LaneAnyWalls<D>, R>>(form);
                        });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {

std::unique_ptr<EnsembleBatch> make_batch(const BatchForm& form) {
  return form.vector == VectorTarget::avx512 ? N_AVX3::make_ring_batch(form)
                                             : N_AVX2::make_ring_batch(form);
}

}  // namespace bounce
#endif
