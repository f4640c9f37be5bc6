// A batch of an ensemble: one scene a lane.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/plan.hpp"
#include "kernels/stepping/ring_shape.hpp"
#include "kernels/stepping/staged_stepper.hpp"

namespace bounce {

/// The stages of one step, or null for a lane that stands still.
using LaneStages = const std::vector<StageConstants>*;

/// Scenes of one shape and law side by side. Lanes do not touch each other's numbers: each gives
/// the bits it would give beside any others.
class EnsembleBatch {
 public:
  virtual ~EnsembleBatch() = default;
  [[nodiscard]] virtual std::size_t lanes() const = 0;
  /// Puts a scene into a lane; `walls` at most as many as the batch was made for.
  virtual void write(std::size_t lane, const State& state, const std::vector<Wall>& walls) = 0;
  virtual void read(std::size_t lane, State& state) const = 0;
  /// Takes `steps` steps of the given stages, one entry a lane, all of the same number of stages.
  virtual void run(std::span<const LaneStages> stages, std::int64_t steps) = 0;
};

/// What a batch is compiled and made for.
struct BatchForm {
  RingShape shape;
  PairLaw law;
  bool floors_only = true;  ///< every scene has at most one wall, with normal (0, 1)
  std::size_t most_walls = 0;
  VectorTarget vector = VectorTarget::avx2;
};

/// Null if no batch is compiled for this form; find_ring_form says why.
std::unique_ptr<EnsembleBatch> make_batch(const BatchForm& form);

}  // namespace bounce
