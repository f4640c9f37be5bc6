// Greenspan's completely conservative method (D. Greenspan, Conservative numerical methods for
// x'' = f(x), J. Comput. Phys. 56 (1984) 28), for the paper's law: implicit, of order 2, and
// reversible. Between contacts it keeps energy, momentum and angular momentum at any step, but for
// rounding.
//
// A step from x, v to x', v', with d = x_i - x_j and s = |d|^2 of a bond:
//
//   x' = x + dt (v + v')/2,   v' = v + dt (g + sum over bonds of F),   F = -D (d + d'),
//   D = (V(s') - V(s)) / (s' - s)
//
//  1. Energy: F (d' - d) = -D (s' - s) = V(s) - V(s'), and (x' - x) (v' - v) dt^-1 is the kinetic
//     energy's change. Momentum: F is opposite for the two particles. Angular momentum: F lies
//     along the mean of d and d', and x' - x along the mean of the velocities.
//  2. V = -G/(2 s) + H/(4 s^2) has a divided difference without any difference: with u = 1/s,
//     D = u u' (G - H (u + u')/2) / 2. It is exact however near s' is to s. For u' = u, F is the
//     law's force.
//  3. The unknown is the way of each particle, w = x' - x: w = dt v + dt^2/2 a(x, x + w), by
//     Newton with Eigen's sparse LU (the matrix is not symmetric), which is kept as long as the
//     corrections shrink well, through many steps of an ordinary motion.
//  4. A wall acts after the step, as in the listing, by either contact rule (wall_rule.hpp). The
//     equations know nothing of it: a pressed particle pulls its neighbours a little way into the
//     wall within a step.
#pragma once

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// Why the method cannot run the problem (its exponents); empty if it can.
std::string conservative_refusal(const Problem& problem);

/// Steps of problem.step. A step whose equations have no solution that Newton finds leaves a state
/// that is not finite: so it shows as an explicit method beyond its edge does.
class ConservativeStepper final : public Stepper {
 public:
  /// The problem has to outlive it. Throws std::invalid_argument with conservative_refusal().
  explicit ConservativeStepper(const Problem& problem);
  void advance(std::int64_t steps) override;
  [[nodiscard]] State state() const override { return state_; }
  [[nodiscard]] Snapshot save() const override { return {state_, false, step_}; }
  /// Throws std::invalid_argument for a snapshot in the midst of a step.
  void restore(const Snapshot& snapshot) override;
  [[nodiscard]] std::int64_t step() const override { return step_; }
  /// Sums of the forces of all bonds so far.
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  /// Factorisations of Newton's matrix so far.
  [[nodiscard]] std::int64_t factorisations() const { return factorisations_; }

 private:
  struct Bond {
    std::size_t i, j;
    double attraction, repulsion;
  };
  using Matrix = Eigen::SparseMatrix<double>;

  void take_step();
  bool solve();
  void accelerate();
  void factorise();
  void meet_walls();

  const Problem* problem_;
  std::vector<Bond> bonds_;
  State state_;
  std::int64_t step_ = 0, evaluations_ = 0, factorisations_ = 0;
  Eigen::VectorXd x_, v_, way_, acceleration_;  // x1, y1, x2, y2, ...
  Matrix matrix_;
  Eigen::SparseLU<Matrix> solver_;
  bool has_pattern_ = false, has_factors_ = false;
};

}  // namespace bounce
