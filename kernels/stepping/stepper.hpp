// What every kernel looks like from outside.
#pragma once

#include <cstddef>
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

/// When a wall acted in a step of a kernel that locates contacts: s after the step's start.
struct WallReport {
  std::int64_t step = 0;  ///< steps taken before it
  std::size_t wall = 0;
  double first = 0.0, last = 0.0;
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
  /// From now on adds there what each wall does in each step, if this kernel knows that (true); a
  /// null pointer ends it.
  virtual bool report_walls(std::vector<WallReport>* /*to*/) { return false; }
  /// Steps taken since the start.
  [[nodiscard]] virtual std::int64_t step() const = 0;
};

}  // namespace bounce
