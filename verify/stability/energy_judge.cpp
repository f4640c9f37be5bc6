#include "verify/stability/energy_judge.hpp"

#include <algorithm>

#include "verify/stability/vibration.hpp"
#include "verify/watch/compensated_sum.hpp"

namespace bounce {

EnergyJudge::EnergyJudge(const Problem& problem, double growth)
    : problem_(&problem), growth_(growth), start_(energies(problem.initial)) {}

EnergyJudge::Energies EnergyJudge::energies(const State& state) const {
  CompensatedSum own, gravity;
  own.add(elastic_energy(*problem_, state));
  const Vec2 g = problem_->gravity;
  for (std::size_t i = 0; i < state.size(); ++i) {
    own.add(0.5 * (state.vx[i] * state.vx[i] + state.vy[i] * state.vy[i]));
    gravity.add(-(g.x * state.x[i] + g.y * state.y[i]));
  }
  return {own.value(), gravity.value()};
}

bool EnergyJudge::is_good(const State& state) const {
  if (!is_finite(state)) return false;
  const Energies now = energies(state);
  const double fallen = std::max(start_.gravity - now.gravity, 0.0);
  const double gained = now.own + now.gravity - start_.own - start_.gravity;
  return gained <= growth_ * (start_.own + fallen);  // false for a NaN
}

}  // namespace bounce
