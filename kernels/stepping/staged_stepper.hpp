// What the kernels on vectors share: which stages a step takes, the stage that a method holds over
// from step to step (method.hpp), and snapshots. A kernel adds how its particles lie in memory, and
// how it takes one stage of them all.
#pragma once

#include <span>
#include <vector>

#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// A stage with everything that does not change from step to step multiplied out.
struct StageConstants {
  std::vector<BondClass> kick;  ///< by class: kick dt G and kick dt H
  Vec2 gravity;                 ///< kick dt g
  double drift = 0.0;           ///< drift dt
};

/// stage_sequence() with its constants.
struct StepStages {
  std::vector<StageConstants> fresh, joined;
};
StepStages step_stages(const Model& model);

/// Holds the problem's model, not its start: the particles stand once, in the kernel's layout.
class StagedStepper : public Stepper {
 public:
  explicit StagedStepper(const Problem& problem);

  void advance(std::int64_t steps) final;
  [[nodiscard]] State state() const final;
  [[nodiscard]] Snapshot save() const final;
  void restore(const Snapshot& snapshot) final;
  [[nodiscard]] std::int64_t step() const final { return step_; }

 protected:
  /// Takes `steps` times all the given stages.
  virtual void run(std::span<const StageConstants> stages, std::int64_t steps) = 0;
  virtual void read(State& state) const = 0;
  virtual void write(const State& state) = 0;
  [[nodiscard]] const Model& model() const { return model_; }

 private:
  Model model_;
  StepStages stages_;
  std::size_t particles_;
  bool stage_held_ = false;
  std::int64_t step_ = 0;
};

/// Does the last stage of the model's method, scalar, forces in the order of the neighbour list:
/// completes a state for which it is held over.
void finish_step(const Model& model, State& state);

}  // namespace bounce
