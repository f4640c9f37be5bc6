// The accelerations of all particles, one by one, in any arithmetic: for the reference solutions
// and for steps with contacts that are located.
//
//  1. Each bond once: half the divisions of the listing's way, and the forces of a bond are
//     opposite to the last bit, so that they leave the total momentum alone.
//  2. One template for all arithmetics: what two references shall not share is rounding and time
//     stepping, not the model. (That the model itself is right is for the oracle to say.)
//  3. F(R)/R = -G u^a + H u^b with u = 1/R^2, a = (p+1)/2, b = (q+1)/2. For the paper's law that is
//     u^2 (H u - G), no root; other laws go through pow, which costs three times as much.
//
// 840 bonds of the paper's ball, one division and some 15 operations each: 2 to 4 us in double,
// some 12 us in x87's long double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

template <class Real>
class ScalarForces {
 public:
  explicit ScalarForces(const Problem& problem)
      : problem_(&problem),
        particles_(problem.initial.size()),
        is_papers_(problem.law.p == 3.0 && problem.law.q == 5.0),
        attraction_power_(static_cast<Real>(0.5 * (problem.law.p + 1.0))),
        repulsion_power_(static_cast<Real>(0.5 * (problem.law.q + 1.0))) {
    for (std::size_t i = 0; i < particles_; ++i) {
      problem.bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
        if (j < i) return;
        const BondClass& bond = problem.classes[c];
        bonds_.push_back(
            {j, static_cast<Real>(bond.attraction), static_cast<Real>(bond.repulsion)});
      });
      row_end_.push_back(bonds_.size());
    }
  }

  [[nodiscard]] std::size_t particles() const { return particles_; }

  /// Accelerations at the positions x, y: n each.
  void operator()(const Real* x, const Real* y, Real* ax, Real* ay) const {
    const auto gx = static_cast<Real>(problem_->gravity.x);
    const auto gy = static_cast<Real>(problem_->gravity.y);
    std::fill(ax, ax + particles_, gx);
    std::fill(ay, ay + particles_, gy);
    if (is_papers_) {
      add_bonds(x, y, ax, ay, [](const Bond& bond, Real u) {
        return u * u * (bond.repulsion * u - bond.attraction);
      });
    } else {
      add_bonds(x, y, ax, ay,
                [this](const Bond& bond, Real u) { return over_distance(bond, u).force; });
    }
  }

  /// Of particle i along n, at a state (parts of 4 n numbers).
  [[nodiscard]] Pull<Real> pull(std::size_t i, Vec2 n, const StateParts<const Real>& s) const {
    const auto nx = static_cast<Real>(n.x);
    const auto ny = static_cast<Real>(n.y);
    Pull<Real> pull{
        nx * static_cast<Real>(problem_->gravity.x) + ny * static_cast<Real>(problem_->gravity.y),
        Real(0)};
    problem_->bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
      const BondClass& of_class = problem_->classes[c];
      const Bond bond{j, static_cast<Real>(of_class.attraction),
                      static_cast<Real>(of_class.repulsion)};
      const Real dx = s.x[i] - s.x[j], dy = s.y[i] - s.y[j];
      const Real wx = s.vx[i] - s.vx[j], wy = s.vy[i] - s.vy[j];
      const Force force = over_distance(bond, 1 / (dx * dx + dy * dy));
      const Real along = nx * dx + ny * dy;
      pull.acceleration += force.force * along;
      pull.jerk +=
          force.force * (nx * wx + ny * wy) + 2 * force.slope * (dx * wx + dy * wy) * along;
    });
    return pull;
  }

 private:
  struct Bond {
    std::size_t other;
    Real attraction, repulsion;
  };
  // F(R)/R, and its derivative by R^2.
  struct Force {
    Real force, slope;
  };

  template <class Law>
  void add_bonds(const Real* x, const Real* y, Real* ax, Real* ay, const Law& law) const {
    const Bond* bond = bonds_.data();
    for (std::size_t i = 0; i < particles_; ++i) {
      const Real xi = x[i], yi = y[i];
      Real sum_x = ax[i], sum_y = ay[i];
      for (const Bond* const end = bonds_.data() + row_end_[i]; bond != end; ++bond) {
        const std::size_t j = bond->other;
        const Real dx = xi - x[j], dy = yi - y[j];
        const Real f = law(*bond, 1 / (dx * dx + dy * dy));
        const Real fx = f * dx, fy = f * dy;
        sum_x += fx;
        sum_y += fy;
        ax[j] -= fx;
        ay[j] -= fy;
      }
      ax[i] = sum_x;
      ay[i] = sum_y;
    }
  }

  [[nodiscard]] Force over_distance(const Bond& bond, Real u) const {
    const Real attraction = bond.attraction * power(u, attraction_power_);
    const Real repulsion = bond.repulsion * power(u, repulsion_power_);
    return {repulsion - attraction,
            u * (attraction_power_ * attraction - repulsion_power_ * repulsion)};
  }
  static Real power(Real u, Real exponent) {
    if (exponent == 2) return u * u;
    if (exponent == 3) return u * u * u;
    return std::pow(u, exponent);
  }

  const Problem* problem_;
  std::size_t particles_;
  bool is_papers_;
  Real attraction_power_, repulsion_power_;
  std::vector<Bond> bonds_;  // by the lower of their two particles
  std::vector<std::size_t> row_end_;
};

}  // namespace bounce
