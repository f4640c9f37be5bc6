// Sums of a survey (free_flight.hpp) in vectors, whatever the kernel's layout.
#if defined(BOUNCE_SURVEY_SUMS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_SURVEY_SUMS_INL_HPP
#undef BOUNCE_SURVEY_SUMS_INL_HPP
#else
#define BOUNCE_SURVEY_SUMS_INL_HPP
#endif

#include <hwy/highway.h>

#include <cmath>
#include <vector>

#include "kernels/stepping/free_flight.hpp"
#include "kernels/stepping/vector_walls-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The least and greatest in each lane. Not-a-number is passed over.
template <class D>
struct SurveySpan {
  using V = hn::Vec<D>;
  V least, greatest;

  // (Initializers beside the members would be compiled for the file's target, not for this one.)
  HWY_INLINE SurveySpan()
      : least(hn::Set(D(), hwy::HighestValue<double>())),
        greatest(hn::Set(D(), hwy::LowestValue<double>())) {}
  HWY_INLINE void add(V value) {
    least = hn::Min(value, least);
    greatest = hn::Max(value, greatest);
  }
  [[nodiscard]] HWY_INLINE Span of_lanes() const {
    return {hn::GetLane(hn::MinOfLanes(D(), least)), hn::GetLane(hn::MaxOfLanes(D(), greatest))};
  }
};

/// Of particles. One that is not a number shows in the sum of all numbers.
template <class D>
class SurveySums {
  using V = hn::Vec<D>;

 public:
  explicit HWY_INLINE SurveySums(const std::vector<Wall>& walls)
      : walls_(walls),
        reach_(hn::Zero(D())),
        all_(hn::Zero(D())),
        gap_(hn::Set(D(), hwy::HighestValue<double>())) {}

  HWY_INLINE void add(V x, V y, V vx, V vy) {
    vx_.add(vx);
    vy_.add(vy);
    const V ax = hn::Abs(x), ay = hn::Abs(y);
    reach_ = hn::Max(hn::Max(ax, ay), reach_);
    const V speeds = hn::Add(hn::Abs(vx), hn::Abs(vy));
    all_ = hn::Add(all_, hn::Add(hn::Add(ax, ay), speeds));
    gap_ = hn::Min(walls_.distance(D(), x, y), gap_);
  }

  HWY_INLINE void add_to(FlightSurvey& to) const {
    to.vx.add(vx_.of_lanes());
    to.vy.add(vy_.of_lanes());
    to.reach = hn::GetLane(hn::MaxOfLanes(D(), reach_));
    to.gap = hn::GetLane(hn::MinOfLanes(D(), gap_));
    to.finite = std::isfinite(hn::GetLane(hn::SumOfLanes(D(), all_)));
  }

 private:
  AnyWalls walls_;
  SurveySpan<D> vx_, vy_;
  V reach_, all_, gap_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
