// The search for the largest stable value between a stable and an unstable one.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace bounce {

/// First a stable value is sought below the guess and an unstable one above it, ever further away;
/// then the gap is halved (on a logarithmic scale) until the two are within `ratio`. Nothing is
/// taken for granted: both ends have been run.
///
/// Where stable values may lie above unstable ones, `climb` seeks the lowest edge instead: from a
/// value well below the guess up, by `ratio` each time, to the first that is unstable.
class Bracket {
 public:
  /// The first values are the guess divided by 1.35^power and multiplied by 1.25^power (not the
  /// same, so that the guess itself is no value that is tried); the search ends at `lowest` and
  /// `highest`.
  Bracket(double guess, double ratio, double power, double lowest, double highest,
          bool climb = false)
      : climb_(climb), ratio_(ratio), stride_(power), lowest_(lowest), highest_(highest) {
    at_ = std::clamp(guess * std::pow(climb ? 1.5 : 1.35, -power), lowest_, highest_);
    above_ = guess * std::pow(1.25, power);
  }
  [[nodiscard]] double next() const { return at_; }
  /// The verdict on next().
  void take(bool stable) {
    (stable ? stable_ : unstable_) = at_;
    if (stable_ == 0.0) {
      given_up_ = at_ <= lowest_;
      at_ = std::max(at_ * std::pow(1.35, -stride_), lowest_);
      stride_ *= 2.0;
    } else if (climb_ && !std::isfinite(unstable_)) {
      given_up_ = at_ >= highest_;
      at_ = std::min(at_ * ratio_, highest_);
    } else if (!std::isfinite(unstable_)) {
      given_up_ = at_ >= highest_;
      at_ = std::min(std::max(above_, at_ * std::pow(1.25, stride_)), highest_);
      stride_ *= 2.0;
    } else {
      at_ = std::sqrt(stable_) * std::sqrt(unstable_);  // their product may overflow
    }
  }
  [[nodiscard]] double stable() const { return stable_; }      ///< 0 if none was
  [[nodiscard]] double unstable() const { return unstable_; }  ///< infinite if none was
  [[nodiscard]] bool closed() const { return stable_ > 0.0 && unstable_ <= ratio_ * stable_; }
  [[nodiscard]] bool done() const { return given_up_ || closed(); }

 private:
  bool climb_;
  double ratio_, stride_, lowest_, highest_;
  double at_ = 0.0;
  double above_ = 0.0;  // the first value above the guess
  double stable_ = 0.0;
  double unstable_ = std::numeric_limits<double>::infinity();
  bool given_up_ = false;
};

}  // namespace bounce
