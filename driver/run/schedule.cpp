#include "driver/run/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bounce {
namespace {

constexpr std::int64_t listing_interval = 1'000'000;  // steps between the listing's frames
constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

// Steps in `interval`, at least one. Intervals beyond any run are cut off before they overflow.
std::int64_t steps_in(const Scene& scene, double interval) {
  return interval / scene.time.step < 1e18 ? std::max<std::int64_t>(1, scene.steps_until(interval))
                                           : never;
}

std::int64_t next_multiple(std::int64_t step, std::int64_t interval) {
  return interval == never ? never : (step / interval + 1) * interval;
}

}  // namespace

Schedule::Schedule(const Scene& scene, bool listing_frames)
    : scene_(scene),
      end_(scene.steps_until(scene.time.end)),
      monitor_steps_(steps_in(scene, scene.output.monitor_every)),
      listing_frames_(listing_frames) {
  for (const double t : scene.output.frames_at) frames_.push_back(scene.steps_until(t));
  std::sort(frames_.begin(), frames_.end());
}

std::int64_t Schedule::next_frame(std::int64_t step) const {
  if (const auto every = scene_.output.frames_every) {
    if (steps_in(scene_, *every) == never) return never;
    // The k-th frame is at k times the interval, rounded to a step: k is guessed, then corrected.
    auto k = static_cast<std::int64_t>(static_cast<double>(step) * scene_.time.step / *every);
    const auto at = [&] { return scene_.steps_until(static_cast<double>(k) * *every); };
    while (at() <= step) ++k;
    return at();
  }
  const auto next = std::upper_bound(frames_.begin(), frames_.end(), step);
  return next == frames_.end() ? never : *next;
}

std::int64_t Schedule::next(std::int64_t step) const {
  std::int64_t next = std::min(end_, next_multiple(step, monitor_steps_));
  next = std::min(next, next_frame(step));
  if (listing_frames_) next = std::min(next, next_multiple(step, listing_interval));
  return next;
}

bool Schedule::sample_due(std::int64_t step) const {
  return step % monitor_steps_ == 0 || step == end_;
}

bool Schedule::frame_due(std::int64_t step) const {
  if (step == 0 && scene_.output.frames_every) return true;
  return next_frame(step - 1) == step;
}

bool Schedule::listing_frame_due(std::int64_t step) const {
  return listing_frames_ && step > 0 && (step % listing_interval == 0 || step == end_);
}

}  // namespace bounce
