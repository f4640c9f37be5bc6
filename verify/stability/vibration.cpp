#include "verify/stability/vibration.hpp"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "verify/watch/compensated_sum.hpp"

namespace bounce {

double elastic_energy(const Problem& problem, const State& state) {
  std::vector<double> at_rest;
  for (const BondClass& bond : problem.classes) {
    at_rest.push_back(potential(problem.law, bond, bond.rest * bond.rest));
  }
  const BondList& bonds = problem.bonds;
  CompensatedSum sum;
  for (std::size_t i = 0; i < bonds.particles(); ++i) {
    const auto end = static_cast<std::size_t>(bonds.start[i + 1]);
    for (auto e = static_cast<std::size_t>(bonds.start[i]); e < end; ++e) {
      const auto j = static_cast<std::size_t>(bonds.neighbour[e]);
      if (j < i) continue;
      const double dx = state.x[i] - state.x[j];
      const double dy = state.y[i] - state.y[j];
      const std::uint8_t kind = bonds.bond_class[e];
      sum.add(potential(problem.law, problem.classes[kind], dx * dx + dy * dy) - at_rest[kind]);
    }
  }
  return sum.value();
}

Vec2 mean_velocity(const State& state) {
  CompensatedSum x, y;
  for (std::size_t i = 0; i < state.size(); ++i) {
    x.add(state.vx[i]);
    y.add(state.vy[i]);
  }
  const auto n = static_cast<double>(state.size());
  return {x.value() / n, y.value() / n};
}

double inner_motion(const State& state) {
  const Vec2 mean = mean_velocity(state);
  CompensatedSum sum;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double u = state.vx[i] - mean.x;
    const double v = state.vy[i] - mean.y;
    sum.add(0.5 * (u * u + v * v));
  }
  return sum.value();
}

double shortest_rest(const Problem& problem) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const BondClass& bond : problem.classes) shortest = std::min(shortest, bond.rest);
  return shortest;
}

void disturb(State& state, double size) {
  std::mt19937_64 random(1);  // NOLINT(cert-msc51-cpp): always the same start
  // Not std::uniform_real_distribution, whose numbers differ from library to library.
  const auto next = [&] { return size * (static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0); };
  for (double& x : state.x) x += next();
  for (double& y : state.y) y += next();
}

void push(State& state, Vec2 velocity) {
  for (double& vx : state.vx) vx += velocity.x;
  for (double& vy : state.vy) vy += velocity.y;
}

}  // namespace bounce
