#include "kernels/stepping/staged_stepper.hpp"

namespace bounce {
namespace {

StageConstants constants_of(const Model& model, Stage stage) {
  const double kick = stage.kick * model.step;
  StageConstants constants;
  for (const BondClass& bond : model.classes) {
    constants.kick.push_back({kick * bond.attraction, kick * bond.repulsion, bond.rest});
  }
  constants.gravity = {kick * model.gravity.x, kick * model.gravity.y};
  constants.drift = stage.drift * model.step;
  return constants;
}

}  // namespace

StepStages step_stages(const Model& model) {
  const Method& method = *model.method;
  StepStages stages;
  for (const Stage& stage : method.stages) stages.fresh.push_back(constants_of(model, stage));
  if (!method.first_same_as_last) return stages;
  stages.fresh.pop_back();
  stages.merged = stages.fresh;
  const Stage first = method.stages.front();
  const double kick = first.kick + method.stages.back().kick;
  stages.merged.front() = constants_of(model, {kick, first.drift});
  return stages;
}

StagedStepper::StagedStepper(const Problem& problem)
    : model_(problem), stages_(step_stages(problem)), particles_(problem.initial.size()) {}

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
  State state(particles_);
  read(state);
  if (kick_pending_) kick_only(model_, model_.method->stages.back().kick, state);
  return state;
}

Snapshot StagedStepper::save() const {
  Snapshot snapshot{State(particles_), kick_pending_, step_};
  read(snapshot.state);
  return snapshot;
}

void StagedStepper::restore(const Snapshot& snapshot) {
  write(snapshot.state);
  kick_pending_ = snapshot.kick_pending;
  step_ = snapshot.step;
}

void kick_only(const Model& model, double kick, State& state) {
  const double scale = kick * model.step;
  for (std::size_t i = 0; i < state.size(); ++i) {
    Vec2 a = model.gravity;
    model.bonds.visit_row(i, [&](std::size_t j, std::size_t bond_class) {
      const double dx = state.x[i] - state.x[j];
      const double dy = state.y[i] - state.y[j];
      const double f = force_over_distance(model.law, model.classes[bond_class], dx * dx + dy * dy);
      a.x += f * dx;
      a.y += f * dy;
    });
    state.vx[i] += scale * a.x;
    state.vy[i] += scale * a.y;
  }
}

}  // namespace bounce
