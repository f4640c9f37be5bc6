// What every kernel looks like from outside.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/model/state.hpp"

namespace bounce {

/// A state as a kernel holds it between steps: enough to go on, bit for bit, as if never stopped.
struct Snapshot {
  State state;
  bool stage_held = false;           ///< the last stage of the last step is still due (method.hpp)
  std::int64_t step = 0;             ///< steps taken
  std::vector<std::uint64_t> own{};  ///< what only the kernel that saved it understands
};

/// A kernel at work on one ball. Not thread-safe; advance() may use threads of its own.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Takes `steps` steps. advance(a) then advance(b) gives the bits of advance(a + b).
  virtual void advance(std::int64_t steps) = 0;
  /// Positions and velocities at the current step, all its stages done.
  [[nodiscard]] virtual State state() const = 0;
  /// For going back or going on elsewhere; restore() accepts any kernel's snapshot of this problem.
  [[nodiscard]] virtual Snapshot save() const = 0;
  virtual void restore(const Snapshot& snapshot) = 0;
  /// Puts a state that is off by roundings from what this kernel can hold into that form.
  virtual void conform(State& /*state*/) const {}
  /// Steps taken since the start.
  [[nodiscard]] virtual std::int64_t step() const = 0;
};

}  // namespace bounce
