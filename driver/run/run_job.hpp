// A run, from a problem that is ready to a directory that is published: what bounce run and bounce
// resume share.
#pragma once

#include <optional>

#include "driver/output/run_directory.hpp"
#include "driver/run/checkpoint.hpp"
#include "driver/scene/state_file.hpp"
#include "kernels/model/problem.hpp"

namespace bounce {

/// A run is written down that often unless asked otherwise, s.
inline constexpr double usual_checkpoints = 60.0;

struct RunJob {
  RunSettings settings;
  Scene scene;
  Problem problem;
  std::optional<State> held;                    ///< of the start, if its file had one
  double checkpoint_every = usual_checkpoints;  ///< s of wall time; 0: none is written
  std::optional<Checkpoint> from{};             ///< where it goes on; nothing: from the start
};

/// Runs, writes all files into the directory and publishes it, prints the summary; the exit code: 0
/// complete, 3 unstable, 4 something could not be written, or that of a signal. Throws PlanError.
int carry_out(RunJob& job, RunDirectory& directory);

}  // namespace bounce
