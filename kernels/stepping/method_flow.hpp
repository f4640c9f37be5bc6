// One step of a method (method.hpp), of any length, in double precision, particle by particle: the
// Flow (contact_course.hpp) of steps with contacts.
//
// A step is made from its start to its end, no stage is held over: a method that begins with the
// kick it ends with has its force from the last step, as long as no particle has been moved.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/contact_course.hpp"
#include "kernels/stepping/method.hpp"
#include "kernels/stepping/scalar_forces.hpp"

namespace bounce {

class MethodFlow {
 public:
  using Real = double;

  /// The problem has to outlive the flow.
  explicit MethodFlow(const Problem& problem)
      : stages_(problem.method->stages),
        forces_(problem),
        end_(4 * problem.initial.size()),
        pull_(2 * problem.initial.size()),
        held_(2 * problem.initial.size()) {}

  [[nodiscard]] const ScalarForces<double>& forces() const { return forces_; }
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& end() const { return end_; }

  void begin(const std::vector<double>& state, const Resting& resting) {
    start_ = state;
    resting_ = &resting;
  }
  double attempt(double left) {
    retake(left);
    return left;
  }
  void retake(double h) {
    end_ = start_;
    const std::size_t half = end_.size() / 2;
    for (const Stage& stage : stages_) {
      if (stage.kick != 0.0) {
        evaluate();
        const double kick = stage.kick * h;
        for (std::size_t k = 0; k < half; ++k) end_[half + k] += kick * held_[k];
      }
      const double drift = stage.drift * h;
      if (drift == 0.0) continue;
      for (std::size_t k = 0; k < half; ++k) end_[k] += drift * end_[half + k];
    }
  }
  void accept() { start_ = end_; }

 private:
  // Accelerations at the positions of end_, less what walls do not let their particles have.
  void evaluate() {
    const std::size_t half = end_.size() / 2, n = half / 2;
    if (at_.size() != half || !std::equal(at_.begin(), at_.end(), end_.begin())) {
      ++evaluations_;
      at_.assign(end_.begin(), end_.begin() + static_cast<std::ptrdiff_t>(half));
      forces_(end_.data(), end_.data() + n, pull_.data(), pull_.data() + n);
    }
    held_ = pull_;
    resting_->hold(held_.data(), held_.data() + n);
  }

  std::span<const Stage> stages_;
  ScalarForces<double> forces_;
  const Resting* resting_ = nullptr;
  std::vector<double> start_, end_;
  std::vector<double> at_;           // positions of the last evaluation
  std::vector<double> pull_, held_;  // accelerations x, then y
  std::int64_t evaluations_ = 0;
};

}  // namespace bounce
