// What the vector kernels share: the walk through a method's stages, the pending kick of
// first-same-as-last methods, and the snapshots. A kernel adds its data layout and its passes.
#pragma once

#include <span>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/method.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// A stage with everything that does not change from step to step multiplied out.
struct StageConstants {
  std::vector<BondClass> kick;  ///< by class: kick dt G and kick dt H
  Vec2 gravity;                 ///< kick dt g
  double drift = 0.0;           ///< drift dt
};

/// The stages of a step.
struct StepStages {
  std::vector<StageConstants> fresh;  ///< of a step that no kick is pending for
  std::vector<StageConstants>
      merged;  ///< of one that takes over the pending kick; empty: none does
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
  bool kick_pending_ = false;
  std::int64_t step_ = 0;
};

/// v += kick dt a(x), scalar, in the order of the neighbour list.
void kick_only(const Model& model, double kick, State& state);

}  // namespace bounce
