// The accelerations of all particles, in any arithmetic: for the reference solutions and for steps
// with contacts that are located.
//
//  1. Each bond once: half the divisions of the listing's way, and the forces of a bond are
//     opposite to the last bit, so that they leave the total momentum alone.
//  2. Bonds are taken in runs: bond k of a run binds particle `first` + k to `other` + k, and all
//     have one class. The paper's ball has 7 long ones, and short ones where a ring closes.
//     A run is two plain loops over neighbouring numbers, which the compiler puts into vectors;
//     what acts on the other ends waits in a buffer, as the two ends of a run may overlap:
//
//       x[first ..] - x[other ..]  ->  fx[0 .. block), ax[first ..] +=
//                                      fx[0 .. block)  ->  ax[other ..] -=
//
//     Each number has its one order of operations, so the bits are the same for any vectors.
//  3. One template for all arithmetics: what two references shall not share is rounding and time
//     stepping, not the model. (That the model itself is right is for the oracle to say.)
//  4. F(R)/R = -G u^a + H u^b with u = 1/R^2, a = (p+1)/2, b = (q+1)/2. For the paper's law that is
//     u^2 (H u - G), no root; other laws go through pow, which costs many times as much.
//
// 840 bonds of the paper's ball, one division and some 15 operations each, in vectors of 4: half of
// the time of bond by bond, as seen on an AMD EPYC. Loads and stores decide; without the division
// it would take 0.9 of it.
//
// Not taken: by particle, with its bonds gathered (twice the divisions, and a gather takes as long
// as its numbers one by one).
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/model/problem.hpp"

namespace bounce {

/// Where a state's numbers stand in one array of 4 n: x, y, vx, vy, n each.
template <class Number>
struct StateParts {
  Number *x, *y, *vx, *vy;
  StateParts(Number* state, std::size_t n)
      : x(state), y(state + n), vx(state + 2 * n), vy(state + 3 * n) {}
};

/// What acts on one particle along a direction, and how fast that changes.
template <class Real>
struct Pull {
  Real acceleration;  ///< cm/s^2
  Real jerk;          ///< cm/s^3
};

/// Of a problem, which has to outlive this. Real is double or long double.
template <class Real>
class BondForces {
 public:
  explicit BondForces(const Problem& problem);
  [[nodiscard]] std::size_t particles() const { return problem_->initial.size(); }

  /// Accelerations (cm/s^2) at the positions x, y: n each.
  void operator()(const Real* x, const Real* y, Real* ax, Real* ay) const;

  /// Of particle i along n, at a state (parts of 4 n numbers).
  [[nodiscard]] Pull<Real> pull(std::size_t i, Vec2 n, const StateParts<const Real>& s) const;

 private:
  struct Bond {
    Real attraction, repulsion;
  };
  struct Run {
    std::size_t first, other, length;
    Bond bond;
  };
  // F(R)/R, and its derivative by R^2.
  struct Force {
    Real force, slope;
  };

  [[nodiscard]] Bond bond(std::size_t bond_class) const;
  void find_runs();
  template <class Law>
  void add_bonds(const Real* x, const Real* y, Real* ax, Real* ay, const Law& law) const;
  [[nodiscard]] Force over_distance(const Bond& bond, Real u) const;

  const Problem* problem_;
  bool is_papers_;
  Real attraction_power_, repulsion_power_;
  std::vector<Run> runs_;
};

}  // namespace bounce
