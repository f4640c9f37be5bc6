#include "kernels/stepping/staged_stepper.hpp"

#include "kernels/model/wall_rule.hpp"

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

// v += time a(x).
void kick(const Model& model, double time, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    Vec2 a = model.gravity;
    model.bonds.visit_row(i, [&](std::size_t j, std::size_t bond_class) {
      const double dx = state.x[i] - state.x[j];
      const double dy = state.y[i] - state.y[j];
      const double f = force_over_distance(model.law, model.classes[bond_class], dx * dx + dy * dy);
      a.x += f * dx;
      a.y += f * dy;
    });
    state.vx[i] += time * a.x;
    state.vy[i] += time * a.y;
  }
}

// What the wall does to one particle after a drift of `drift` (s). Not-a-number is let be.
void meet(const Wall& wall, double drift, std::size_t i, State& state) {
  if (!(wall_distance(wall, state.x[i], state.y[i]) <= 0.0)) return;
  const Motion after =
      after_wall(wall, drift, {{state.x[i], state.y[i]}, {state.vx[i], state.vy[i]}});
  state.x[i] = after.position.x;
  state.y[i] = after.position.y;
  state.vx[i] = after.velocity.x;
  state.vy[i] = after.velocity.y;
}

}  // namespace

StepStages step_stages(const Model& model) {
  const StageSequence sequence = stage_sequence(*model.method);
  StepStages stages;
  for (const Stage& stage : sequence.fresh) stages.fresh.push_back(constants_of(model, stage));
  for (const Stage& stage : sequence.joined) stages.joined.push_back(constants_of(model, stage));
  return stages;
}

StagedStepper::StagedStepper(const Problem& problem)
    : model_(problem), stages_(step_stages(problem)), particles_(problem.initial.size()) {}

void StagedStepper::advance(std::int64_t steps) {
  if (steps <= 0) return;
  step_ += steps;
  if (stages_.joined.empty()) {
    run(stages_.fresh, steps);
    return;
  }
  if (!stage_held_) {
    run(stages_.fresh, 1);
    stage_held_ = true;
    --steps;
  }
  if (steps > 0) run(stages_.joined, steps);
}

State StagedStepper::state() const {
  State state(particles_);
  read(state);
  if (stage_held_) {
    finish_step(model_, state);
    conform(state);
  }
  return state;
}

Snapshot StagedStepper::save() const {
  Snapshot snapshot{State(particles_), stage_held_, step_};
  read(snapshot.state);
  return snapshot;
}

void StagedStepper::restore(const Snapshot& snapshot) {
  write(snapshot.state);
  stage_held_ = snapshot.stage_held;
  step_ = snapshot.step;
}

void finish_step(const Model& model, State& state) {
  const Stage stage = model.method->stages.back();
  kick(model, stage.kick * model.step, state);
  if (stage.drift == 0.0) return;
  const double drift = stage.drift * model.step;
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.x[i] += drift * state.vx[i];
    state.y[i] += drift * state.vy[i];
    for (const Wall& wall : model.walls) meet(wall, drift, i, state);
  }
}

}  // namespace bounce
