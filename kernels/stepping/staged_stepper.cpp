#include "kernels/stepping/staged_stepper.hpp"

#include <utility>

namespace bounce {
namespace {

StageConstants constants_of(const Problem& problem, Stage stage) {
  const double kick = stage.kick * problem.step;
  StageConstants constants;
  for (const BondClass& bond : problem.classes) {
    constants.kick.push_back({kick * bond.attraction, kick * bond.repulsion, bond.rest});
  }
  constants.gravity = {kick * problem.gravity.x, kick * problem.gravity.y};
  constants.drift = stage.drift * problem.step;
  return constants;
}

}  // namespace

StepStages step_stages(const Problem& problem) {
  const Method& method = *problem.method;
  StepStages stages;
  for (const Stage& stage : method.stages) stages.fresh.push_back(constants_of(problem, stage));
  if (!method.first_same_as_last) return stages;
  stages.fresh.pop_back();
  stages.merged = stages.fresh;
  const Stage first = method.stages.front();
  const double kick = first.kick + method.stages.back().kick;
  stages.merged.front() = constants_of(problem, {kick, first.drift});
  return stages;
}

StagedStepper::StagedStepper(Problem problem)
    : problem_(std::move(problem)), stages_(step_stages(problem_)) {}

void StagedStepper::advance(std::int64_t steps) {
  if (steps <= 0) return;
  step_ += steps;
  if (stages_.merged.empty()) {
    run(stages_.fresh, steps);
    return;
  }
  if (!kick_pending_) {
    run(stages_.fresh, 1);
    kick_pending_ = true;
    --steps;
  }
  if (steps > 0) run(stages_.merged, steps);
}

State StagedStepper::state() const {
  State state(problem_.initial.size());
  read(state);
  if (kick_pending_) kick_only(problem_, problem_.method->stages.back().kick, state);
  return state;
}

Snapshot StagedStepper::save() const {
  Snapshot snapshot{State(problem_.initial.size()), kick_pending_, step_};
  read(snapshot.state);
  return snapshot;
}

void StagedStepper::restore(const Snapshot& snapshot) {
  write(snapshot.state);
  kick_pending_ = snapshot.kick_pending;
  step_ = snapshot.step;
}

void kick_only(const Problem& problem, double kick, State& state) {
  const double scale = kick * problem.step;
  const BondList& bonds = problem.bonds;
  for (std::size_t i = 0; i < state.size(); ++i) {
    Vec2 a = problem.gravity;
    for (std::int64_t e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      const auto j = static_cast<std::size_t>(bonds.neighbour[entry]);
      const double dx = state.x[i] - state.x[j];
      const double dy = state.y[i] - state.y[j];
      const double f = force_over_distance(problem.law, problem.classes[bonds.bond_class[entry]],
                                           dx * dx + dy * dy);
      a.x += f * dx;
      a.y += f * dy;
    }
    state.vx[i] += scale * a.x;
    state.vy[i] += scale * a.y;
  }
}

}  // namespace bounce
