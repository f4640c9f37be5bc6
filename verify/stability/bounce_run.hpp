// Runs of one bounce, from just above a wall until the ball has left it: how long it takes, and how
// stiff the ball gets on its way.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/stability/trials.hpp"
#include "verify/watch/margin.hpp"

namespace bounce {

/// The speed at which the problem's ball will meet the wall it starts nearest to, from its own
/// speed towards it and its fall, cm/s. 0 if there is no wall or it never comes there.
double meeting_speed(const Problem& problem);

/// The problem's start moved along the normal of its nearest wall to `start_gap` above it, with
/// this speed towards it; what else moves (along the wall, within the ball) stays. The problem must
/// have a wall.
State just_above_wall(const Problem& problem, double speed);
inline constexpr double start_gap = 1e-3;  ///< cm; ten times what counts as contact

/// What was seen of a bounce.
struct BounceRun {
  bool stable = false;  ///< it did not become unstable at this step
  bool left = false;    ///< the ball came off the wall and rose for a tenth of its time there
  double end = 0.0;     ///< s after the start: when that was, or where the watching ended
  std::optional<Margin> margin;  ///< the greatest part of the stable step used
};

/// Follows the bounces of problems that differ in numbers alone (see run_trials), each for `steps`
/// at most. Each is looked at every `look_every` steps; a look costs as much as many steps.
/// `growth`: what counts as unstable (EnergyJudge).
std::vector<BounceRun> follow_bounces(std::span<const Problem> problems,
                                      std::span<const std::int64_t> steps, std::int64_t look_every,
                                      std::span<const double> growth, const TrialOptions& options);

}  // namespace bounce
