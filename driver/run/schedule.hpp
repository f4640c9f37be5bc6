// When a run looks at its state: the steps at which something is written.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/model/scene.hpp"

namespace bounce {

/// The events of a run from step 0 to its end, counted in nominal steps as the paper counts them.
class Schedule {
 public:
  /// Steps from the scene's end time; the listing's frames only if asked for.
  Schedule(const Scene& scene, bool listing_frames);

  [[nodiscard]] std::int64_t end() const { return end_; }
  /// The first event after `step`, at most end().
  [[nodiscard]] std::int64_t next(std::int64_t step) const;
  /// A row of monitor.csv: every monitor_every, at least one step apart, and at the end.
  [[nodiscard]] bool sample_due(std::int64_t step) const;
  /// A frame at one of the scene's times.
  [[nodiscard]] bool frame_due(std::int64_t step) const;
  /// A frame of the listing: at each whole million of steps, and at the end.
  [[nodiscard]] bool listing_frame_due(std::int64_t step) const;

 private:
  [[nodiscard]] std::int64_t next_frame(std::int64_t step) const;

  Scene scene_;
  std::int64_t end_;
  std::int64_t monitor_steps_;
  std::vector<std::int64_t> frames_;  // of frames_at, increasing
  bool listing_frames_;
};

}  // namespace bounce
