// A step as plain scalar code, to compare the kernels with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/model/method.hpp"
#include "kernels/model/pair_law.hpp"
#include "kernels/model/problem.hpp"

namespace bounce {

/// The resolved rule from its definition: a straight path from where the particle came from, met by
/// the wall at a part of the drift, and another path from there. Resting: came from the wall.
inline void meet_resolved(const Wall& w, double drift, std::size_t i, const State& from,
                          State& to) {
  const double d = wall_distance(w, to.x[i], to.y[i]);
  const double came = wall_distance(w, from.x[i], from.y[i]);
  const double vn = w.normal.x * to.vx[i] + w.normal.y * to.vy[i];
  const Vec2 t{to.vx[i] - vn * w.normal.x, to.vy[i] - vn * w.normal.y};
  const bool resting = w.beta == 0.0 && w.alpha < 1.0 && came <= 1e-14;
  const double alpha = resting ? 0.0 : w.alpha;
  // Part of the drift; below 0 where a stage stepped back behind the wall before.
  const double meets = came == d ? 1.0 : std::max(came / (came - d), -1.0);
  const double rest = (1.0 - meets) * drift;
  to.vx[i] = alpha * t.x + w.beta * vn * w.normal.x;
  to.vy[i] = alpha * t.y + w.beta * vn * w.normal.y;
  to.x[i] = from.x[i] + meets * drift * (t.x + vn * w.normal.x) + rest * to.vx[i];
  to.y[i] = from.y[i] + meets * drift * (t.y + vn * w.normal.y) + rest * to.vy[i];
}

/// One stage, written as plainly as can be.
inline State scalar_stage(const Problem& problem, Stage stage, const State& from) {
  State to = from;
  const BondList& bonds = problem.bonds;
  for (std::size_t i = 0; i < from.size(); ++i) {
    double ax = problem.gravity.x;
    double ay = problem.gravity.y;
    for (std::int64_t e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      const auto j = static_cast<std::size_t>(bonds.neighbour[entry]);
      const double dx = from.x[i] - from.x[j];
      const double dy = from.y[i] - from.y[j];
      const double f = force_over_distance(problem.law, problem.classes[bonds.bond_class[entry]],
                                           dx * dx + dy * dy);
      ax += f * dx;
      ay += f * dy;
    }
    to.vx[i] += stage.kick * problem.step * ax;
    to.vy[i] += stage.kick * problem.step * ay;
    if (stage.drift == 0.0) continue;
    const bool forth = stage.drift > 0.0;  // what steps back meets no wall
    to.x[i] += stage.drift * problem.step * to.vx[i];
    to.y[i] += stage.drift * problem.step * to.vy[i];
    for (const Wall& w : problem.walls) {
      const double d = wall_distance(w, to.x[i], to.y[i]);
      if (d > 0.0 || !forth) continue;
      if (w.contact == Contact::resolved) {
        meet_resolved(w, stage.drift * problem.step, i, from, to);
        continue;
      }
      const double vn = w.normal.x * to.vx[i] + w.normal.y * to.vy[i];
      const double tx = to.vx[i] - vn * w.normal.x;
      const double ty = to.vy[i] - vn * w.normal.y;
      to.x[i] -= 2.0 * d * w.normal.x;
      to.y[i] -= 2.0 * d * w.normal.y;
      to.vx[i] = w.alpha * tx + w.beta * vn * w.normal.x;
      to.vy[i] = w.alpha * ty + w.beta * vn * w.normal.y;
    }
  }
  return to;
}

inline State scalar_step(const Problem& problem, const State& from) {
  return scalar_stage(problem, {1.0, 1.0}, from);
}

inline double largest_difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]);
    if (!(d <= largest)) largest = d;  // a NaN stays
  }
  return largest;
}

}  // namespace bounce
