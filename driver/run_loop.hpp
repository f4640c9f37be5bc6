// Takes a stepper from its start to the end of a schedule, watching it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "driver/schedule.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"
#include "verify/monitor.hpp"

namespace bounce {

/// What a run tells its surroundings. Called only with states that the watch has passed.
struct RunHooks {
  /// If set: the state of the sample that follows.
  std::function<void(std::int64_t step, const State&)> margin;
  std::function<void(std::int64_t step, const Sample&)> sample;
  std::function<void(std::int64_t step, const State&)> frame;
  std::function<void(std::int64_t step, const State&)> listing_frame;
  std::function<void(std::int64_t step)> progress;  ///< about twenty times a second or more
  std::function<bool()> stop;                       ///< asked as often; true ends the run
};

enum class RunStatus { complete, interrupted, unstable };

/// How a run ended.
struct RunResult {
  RunStatus status = RunStatus::complete;
  State last;                    ///< the last good state
  std::int64_t step = 0;         ///< of that state
  Sample start;                  ///< of the state at step 0
  double seconds = 0.0;          ///< wall time of the loop, with everything written in it
  std::int64_t steps_timed = 0;  ///< steps taken in that time
  std::optional<Trouble> trouble;
  std::int64_t trouble_step = 0;  ///< first step that the watch refuses
};

/// Runs from the stepper's step 0. When the watch refuses a state, goes back to the last one it
/// passed and finds the first refused step by bisection, which is exact because runs repeat to the
/// bit.
RunResult run_loop(Stepper& stepper, const Problem& problem, const Schedule& schedule,
                   const RunHooks& hooks);

}  // namespace bounce
