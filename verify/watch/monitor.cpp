#include "verify/watch/monitor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "kernels/model/method.hpp"
#include "kernels/model/powers.hpp"
#include "verify/watch/compensated_sum.hpp"

namespace bounce {
namespace {

// Rounding errors of 1e-16 of the ball's energies, gathered over 1e7 steps as if they all had one
// sign.
constexpr double rounding_share = 1e-9;

// How often the elastic energy of the start may come and go through the method's own error: the
// swing of a vibration at 82 % of the edge of stability, or of all of them, stiff and soft, nearer.
constexpr double elastic_swing = 10.0;

// True if `value` should replace `smallest`; a NaN replaces any number and stays.
bool is_smaller(double value, double smallest) {
  return !(value >= smallest) && !std::isnan(smallest);
}

// The larger of both; a NaN stays.
void raise(double& largest, double value) {
  if (!(value <= largest) && !std::isnan(largest)) largest = value;
}

double squared_distance(const State& s, std::size_t i, std::size_t j) {
  const double dx = s.x[i] - s.x[j];
  const double dy = s.y[i] - s.y[j];
  return dx * dx + dy * dy;
}

void measure_bonds(const Problem& problem, const State& state, Sample& sample) {
  const PotentialOf potential_of(problem.law);
  CompensatedSum energy;
  double smallest = std::numeric_limits<double>::infinity();  // (R/R0)^2
  double fastest = 0.0;                                       // (v/R0)^2
  std::vector<double> per_rest_squared;                       // a division a class, not a bond
  for (const BondClass& bond : problem.classes) {
    per_rest_squared.push_back(1.0 / (bond.rest * bond.rest));
  }
  problem.bonds.for_each_bond([&](std::size_t i, std::size_t j, std::size_t c) {
    const double r2 = squared_distance(state, i, j);
    energy.add(potential_of(problem.classes[c], r2));
    const double ux = state.vx[i] - state.vx[j], uy = state.vy[i] - state.vy[j];
    raise(fastest, (ux * ux + uy * uy) * per_rest_squared[c]);
    const double ratio = r2 * per_rest_squared[c];
    if (is_smaller(ratio, smallest)) {
      smallest = ratio;
      sample.ratio_first = static_cast<std::int64_t>(i);
      sample.ratio_second = static_cast<std::int64_t>(j);
    }
  });
  sample.bond = energy.value();
  sample.smallest_ratio = std::sqrt(smallest);
  sample.fastest_bond = std::sqrt(fastest);
}

void measure_motion(const State& s, Sample& sample) {
  CompensatedSum x, y, px, py, kinetic, spin;
  for (std::size_t i = 0; i < s.size(); ++i) {
    x.add(s.x[i]);
    y.add(s.y[i]);
    px.add(s.vx[i]);
    py.add(s.vy[i]);
    kinetic.add(0.5 * (s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i]));
  }
  const auto n = static_cast<double>(s.size());
  sample.centre = {x.value() / n, y.value() / n};
  sample.momentum = {px.value(), py.value()};
  sample.kinetic = kinetic.value();
  for (std::size_t i = 0; i < s.size(); ++i) {
    spin.add((s.x[i] - sample.centre.x) * s.vy[i]);
    spin.add(-(s.y[i] - sample.centre.y) * s.vx[i]);
  }
  sample.angular_momentum = spin.value();
}

void measure_surroundings(const Problem& problem, const State& s, Sample& sample) {
  CompensatedSum gravity;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i) {
    gravity.add(-problem.gravity.x * s.x[i]);
    gravity.add(-problem.gravity.y * s.y[i]);
    if (is_smaller(s.y[i], lowest)) lowest = s.y[i];
    const bool touches =
        std::any_of(problem.walls.begin(), problem.walls.end(), [&](const Wall& wall) {
          return !(wall_distance(wall, s.x[i], s.y[i]) >= contact_distance);
        });
    if (touches) ++sample.on_wall;
    for (const Wall& wall : problem.walls) {
      raise(sample.approach, -(wall.normal.x * s.vx[i] + wall.normal.y * s.vy[i]));
    }
  }
  sample.gravity = gravity.value();
  sample.lowest = lowest;
}

// Bond energy with every bond at rest: the zero of elastic energy.
double rest_bond_energy(const Problem& problem) {
  std::vector<double> entries(problem.classes.size());  // by class; every bond has two
  for (std::size_t i = 0; i < problem.bonds.particles(); ++i) {
    problem.bonds.visit_row(i, [&](std::size_t, std::size_t c) { entries[c] += 1.0; });
  }
  CompensatedSum energy;
  for (std::size_t c = 0; c < entries.size(); ++c) {
    const BondClass& bond = problem.classes[c];
    energy.add(0.5 * entries[c] * potential(problem.law, bond, bond.rest * bond.rest));
  }
  return energy.value();
}

// The least gravity energy -g.x of a unit mass in front of all walls, erg; minus infinity if it
// can fall without end. Where -g = a n + b m with a, b >= 0 and two walls n.x >= c, m.x >= d, -g.x
// is at least a c + b d; one wall across gravity is the same with b = 0.
double lowest_gravity_energy(const Problem& problem) {
  const Vec2 up{-problem.gravity.x, -problem.gravity.y};
  const auto cross = [](Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; };
  if (up.x == 0.0 && up.y == 0.0) return 0.0;
  double least = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < problem.walls.size(); ++i) {
    const Wall& one = problem.walls[i];
    const double along = up.x * one.normal.x + up.y * one.normal.y;
    if (along > 0.0 && cross(one.normal, up) == 0.0) least = std::max(least, along * one.offset);
    for (std::size_t j = 0; j < i; ++j) {
      const Wall& other = problem.walls[j];
      const double area = cross(one.normal, other.normal);
      const double a = cross(up, other.normal) / area, b = cross(one.normal, up) / area;
      if (a >= 0.0 && b >= 0.0 && std::isfinite(a) && std::isfinite(b)) {
        least = std::max(least, a * one.offset + b * other.offset);
      }
    }
  }
  return least;
}

std::string print(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

struct Tightest {
  std::int64_t partner = -1;
  double ratio = std::numeric_limits<double>::infinity();  // R/R0
};

// The particle's bond with the smallest R/R0, or its first one whose R/R0 is not a number.
Tightest tightest_bond(const Problem& problem, const State& state, std::size_t i) {
  Tightest tightest;
  problem.bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
    const double ratio = std::sqrt(squared_distance(state, i, j)) / problem.classes[c].rest;
    if (tightest.partner < 0 || is_smaller(ratio, tightest.ratio)) {
      tightest = {static_cast<std::int64_t>(j), ratio};
    }
  });
  return tightest;
}

// The bond with the most elastic energy, V(R) - V(R0): where energy that appeared from nowhere
// sits, in a bond pressed together or pulled apart. Any bond before one whose energy is not a
// number.
struct Strained {
  std::int64_t first = -1, second = -1;
  double ratio = 0.0;  // R/R0
};
Strained most_strained(const Problem& problem, const State& state) {
  Strained strained;
  double most = 0.0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    problem.bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
      const BondClass& bond = problem.classes[c];
      const double r2 = squared_distance(state, i, j);
      const double energy =
          potential(problem.law, bond, r2) - potential(problem.law, bond, bond.rest * bond.rest);
      if (strained.first >= 0 && !(energy > most)) return;
      most = energy;
      strained = {static_cast<std::int64_t>(i), static_cast<std::int64_t>(j),
                  std::sqrt(r2) / bond.rest};
    });
  }
  return strained;
}

Trouble trouble_at(std::string what, std::int64_t first, std::int64_t second, double ratio) {
  what += "; bond " + std::to_string(first + 1) + "-" + std::to_string(second + 1) +
          " is at R/R0 = " + print(ratio);
  return {std::move(what), first, first, second};
}

std::optional<Trouble> non_finite_number(const Problem& problem, const State& s) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    const bool here = std::isfinite(s.x[i]) && std::isfinite(s.y[i]);
    const bool moving = std::isfinite(s.vx[i]) && std::isfinite(s.vy[i]);
    if (here && moving) continue;
    const Tightest bond = tightest_bond(problem, s, i);
    return trouble_at((here ? "velocity of particle " : "position of particle ") +
                          std::to_string(i + 1) + " is not finite",
                      static_cast<std::int64_t>(i), bond.partner, bond.ratio);
  }
  return std::nullopt;
}

// The bond that changes fastest for its length.
Trouble fastest_bond(const Problem& problem, const State& state, const Stride& stride) {
  std::size_t first = 0, second = 0, bond_class = 0;
  double most = -1.0;
  problem.bonds.for_each_bond([&](std::size_t i, std::size_t j, std::size_t c) {
    const double speed = std::hypot(state.vx[i] - state.vx[j], state.vy[i] - state.vy[j]);
    if (!(speed > most * problem.classes[c].rest)) return;
    most = speed / problem.classes[c].rest;
    first = i;
    second = j;
    bond_class = c;
  });
  return trouble_at(
      "particles " + std::to_string(first + 1) + " and " + std::to_string(second + 1) +
          ", which a bond joins, move by " + print(stride.bond) +
          " of its length against each other in a step, so that one may pass through "
          "the other unnoticed (a smaller time step helps)",
      static_cast<std::int64_t>(first), static_cast<std::int64_t>(second),
      std::sqrt(squared_distance(state, first, second)) / problem.classes[bond_class].rest);
}

// The particle that comes to a wall fastest.
Trouble fastest_approach(const Problem& problem, const State& state, const Stride& stride) {
  std::size_t particle = 0;
  double most = -1.0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (const Wall& wall : problem.walls) {
      const double speed = -(wall.normal.x * state.vx[i] + wall.normal.y * state.vy[i]);
      if (!(speed > most)) continue;
      most = speed;
      particle = i;
    }
  }
  const Tightest bond = tightest_bond(problem, state, particle);
  return trouble_at("particle " + std::to_string(particle + 1) + " moves by " + print(stride.wall) +
                        " times the distance between neighbours towards a wall in a step, so that "
                        "it may pass through a wall unnoticed (a smaller time step helps)",
                    static_cast<std::int64_t>(particle), bond.partner, bond.ratio);
}

// Where something may pass through a neighbour or a wall within a step.
std::optional<Trouble> too_fast(const Problem& problem, const State& state, const Sample& sample) {
  const Stride stride = stride_of(problem, sample);
  if (stride.bond <= 1.0 && stride.wall <= 1.0) return std::nullopt;
  return stride.bond <= 1.0 ? fastest_approach(problem, state, stride)
                            : fastest_bond(problem, state, stride);
}

}  // namespace

Sample measure(const Problem& problem, const State& state) {
  Sample sample;
  measure_bonds(problem, state, sample);
  measure_motion(state, sample);
  measure_surroundings(problem, state, sample);
  return sample;
}

Watch::Watch(const Problem& problem, const State& start)
    : problem_(&problem),
      start_(measure(problem, start)),
      motion_(start_.kinetic + elastic_swing * (start_.bond - rest_bond_energy(problem))),
      floor_(rounding_share * (start_.kinetic + std::abs(start_.bond) + std::abs(start_.gravity))) {
  const double lowest = lowest_gravity_energy(problem) * static_cast<double>(start.size());
  if (std::isfinite(lowest)) fall_ = std::max(0.0, start_.gravity - lowest);
}

double Watch::allowed_gain(double fall) const { return std::max(motion_ + fall, floor_); }

Stride stride_of(const Problem& problem, const Sample& sample) {
  double drift = 0.0, shortest = std::numeric_limits<double>::infinity();
  for (const Stage& stage : problem.method->stages) {
    drift = std::max(drift, std::abs(stage.drift * problem.step));
  }
  for (const BondClass& bond : problem.classes) shortest = std::min(shortest, bond.rest);
  return {sample.fastest_bond * drift, sample.approach * drift / shortest};
}

std::optional<Trouble> Watch::check(const State& state, const Sample& sample) const {
  if (auto trouble = non_finite_number(*problem_, state)) return trouble;
  if (auto trouble = too_fast(*problem_, state, sample)) return trouble;
  const double gain = sample.total() - start_.total();
  const double allowed = allowed_gain(std::max(fall_, start_.gravity - sample.gravity));
  if (std::isfinite(gain) && gain <= allowed) return std::nullopt;
  if (!std::isfinite(gain)) {
    return trouble_at(
        "energy of particle " + std::to_string(sample.ratio_first + 1) + "'s bonds is not finite",
        sample.ratio_first, sample.ratio_second, sample.smallest_ratio);
  }
  const Strained bond = most_strained(*problem_, state);
  return trouble_at("energy jumped by " + print(gain) + " erg, more than the " + print(allowed) +
                        " erg that start and fall account for (a smaller time step may help); most "
                        "of the bonds' energy is in one",
                    bond.first, bond.second, bond.ratio);
}

void Watch::accept(const Sample& sample) {
  fall_ = std::max(fall_, start_.gravity - sample.gravity);
}

}  // namespace bounce
