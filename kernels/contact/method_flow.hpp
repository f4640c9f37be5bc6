// One step of a method (method.hpp), of any length, in double precision, particle by particle: the
// Flow of which contact_solver.hpp makes steps with contacts.
//
// A step is made from its start to its end, no stage is held over: a method that begins with the
// kick it ends with has its force from the last step, as long as no particle has been moved.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/contact/bond_forces.hpp"
#include "kernels/contact/contact_solver.hpp"
#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"

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

  [[nodiscard]] const BondForces<double>& forces() const { return forces_; }
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
  void retake(double h);
  void accept() { start_ = end_; }

 private:
  // Accelerations at the positions of end_, less what walls do not let their particles have.
  const std::vector<double>& evaluate();

  std::span<const Stage> stages_;
  BondForces<double> forces_;
  const Resting* resting_ = nullptr;
  std::vector<double> start_, end_;
  std::vector<double> at_;           // positions of the last evaluation
  std::vector<double> pull_, held_;  // accelerations x, then y
  std::int64_t evaluations_ = 0;
};

}  // namespace bounce
