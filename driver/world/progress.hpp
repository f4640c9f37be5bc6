// The progress bar.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace bounce {

/// Draws bar, simulated time, steps/s and time left on stderr, at most ten times a second. Does
/// nothing when it is off; removes its line when it goes.
class Progress {
 public:
  /// `step_time` in s. `on` should be false when stderr is not a terminal.
  Progress(bool on, std::int64_t steps, double step_time);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void update(std::int64_t step);

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  bool drawn_ = false;
  std::int64_t steps_;
  double step_time_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// The same for a sweep: bar, cases done, time left. Parts of the work are in any unit.
class CaseProgress {
 public:
  CaseProgress(bool on, std::size_t cases, double work);
  ~CaseProgress();
  CaseProgress(const CaseProgress&) = delete;
  CaseProgress& operator=(const CaseProgress&) = delete;
  void update(std::size_t cases, double work);

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  std::size_t cases_;
  double work_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace bounce
