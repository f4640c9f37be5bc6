// Which of two ways to do the same work is faster now, found while doing it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace bounce {

/// Two threads on one ball are faster than one while both have a core and the cores are near each
/// other; both may change from one moment to the next, without notice. So the work is done in
/// slices: the faster way is kept, the other one tried from time to time, the more seldom the
/// oftener it loses and the more a trial costs. So trials cost little in the long run, however slow
/// the other way is.
class FasterOfTwo {
 public:
  /// The way to do the next slice, 0 or 1; 0 first.
  [[nodiscard]] int next() const { return trial_due() ? 1 - best_ : best_; }

  /// What a step of the slice took; slices too short to compare need not be reported.
  void took(int way, double time) {
    if (way == best_) {
      best_time_ = time;
      ++since_trial_;
    } else if (!warm_) {
      warm_ = true;  // the first slice of a trial wakes threads up and fetches data
    } else {
      end_trial(time);
    }
  }

  [[nodiscard]] int best() const { return best_; }

 private:
  static constexpr std::int64_t least_patience = 16;  // slices
  static constexpr std::int64_t most_patience = 4096;
  static constexpr double trial_share = 0.02;  // of the time, at most, goes into lost trials

  [[nodiscard]] bool trial_due() const { return since_trial_ >= patience_; }

  void end_trial(double time) {
    const double loss = 2.0 * (time / best_time_ - 1.0);  // in slices of the better way
    if (time < best_time_) {
      best_ = 1 - best_;
      best_time_ = time;
      patience_ = least_patience;
    } else {
      const auto earned_back = static_cast<std::int64_t>(std::min(loss / trial_share, 1e9));
      patience_ = std::max(std::min(2 * patience_, most_patience), earned_back);
    }
    since_trial_ = 0;
    warm_ = false;
  }

  int best_ = 0;
  double best_time_ = 0.0;
  bool warm_ = false;
  std::int64_t patience_ = 1;
  std::int64_t since_trial_ = 0;
};

}  // namespace bounce
