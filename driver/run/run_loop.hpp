// Takes a stepper from its start to the end of a schedule, watching it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "driver/run/schedule.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"
#include "verify/watch/monitor.hpp"
#include "verify/watch/words.hpp"

namespace bounce {

/// What a run tells its surroundings. Called only with states that the watch has passed,
/// but for `look`.
struct RunHooks {
  std::function<void(std::int64_t step, const Sample&, const State&)> sample;
  std::function<void(std::int64_t step, const State&)> frame;
  std::function<void(std::int64_t step, const State&)> listing_frame;
  std::function<void(std::int64_t step)> progress;  ///< about twenty times a second or more
  std::function<bool()> stop;                       ///< asked as often; true ends the run
  /// Asked as often; true: the run is to be written down now. None: it never is.
  std::function<bool()> checkpoint_due;
  /// Writes the run down; gets what writes the loop's own numbers. Also called before the last look
  /// of a run that ends or is stopped: what the end alone makes (a row out of turn) is not in it,
  /// so that the run can go on from there as if it had never ended.
  std::function<void(const std::function<void(WordWriter&)>& loop)> checkpoint;
  /// The first step after that one at which `look` wants to be called; none: at no step. It is
  /// called at the start, too.
  std::function<std::int64_t(std::int64_t step)> next_look;
  std::function<void()> look;
};

enum class RunStatus { complete, interrupted, unstable };

/// How a run ended.
struct RunResult {
  RunStatus status = RunStatus::complete;
  State last;                    ///< the last good state
  std::optional<State> held;     ///< the same, with the stage that the method holds over not done
  std::int64_t step = 0;         ///< of that state
  Sample start;                  ///< of the state at step 0
  double seconds = 0.0;          ///< wall time of the loop, with everything written in it
  std::int64_t steps_timed = 0;  ///< steps taken in that time
  std::optional<Trouble> trouble;
  std::int64_t trouble_step = 0;  ///< first step that the watch refuses
  /// Every step from this one to trouble_step has been looked at.
  std::int64_t looked_from = 0;
  State refused;               ///< the state at trouble_step
  bool start_refused = false;  ///< trouble_step is 0: `last` is no good state
};

/// Most steps that are looked at one by one when a run has become unstable: at 360 particles, those
/// between two rows of monitor.csv in the paper's examples. They take about half a second.
std::int64_t steps_to_look_at(std::size_t particles);

/// Runs from the stepper's step 0, or from where the words say that a run stood; the stepper is
/// then put there. When the watch refuses a state, goes back to the last one it passed and looks at
/// every step from there; runs repeat to the bit. If that is more than steps_to_look_at, it first
/// halves the way: a passed state takes the place of the last good one, a refused one that of the
/// end. Energy that swings could be refused, passed and refused again, so the first refused step is
/// exact from `looked_from` on, and no earlier one is known.
RunResult run_loop(Stepper& stepper, const Problem& problem, const Schedule& schedule,
                   const RunHooks& hooks, WordReader* from = nullptr);

}  // namespace bounce
