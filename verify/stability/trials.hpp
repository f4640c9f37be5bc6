// Many runs, each looked at from time to time and followed to its end or to the first state that is
// not good: what a search for an edge of stability is made of.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"

namespace bounce {

/// How trials are run. Neither value changes their outcome.
struct TrialOptions {
  int threads = 0;              ///< 1 to 256; 0: one a core
  std::string vector = "auto";  ///< auto, avx2, avx512
  /// Asked at each look; once true, all trials end, and what they say is worth nothing.
  std::function<bool()> stop{};
};

/// True if trial i may go on. Called by several threads, never for the same trial at once; looks of
/// one trial come in the order of its steps.
using IsGood = std::function<bool(std::size_t i, const State&)>;

/// Runs problem i for steps[i] steps; looks at it every `look_every` steps and at its end. True
/// where every look was good; a state that is not finite never is. The problems differ in numbers
/// alone (E, gravity, step, walls, start). Located contact is run as resolved: what it would do at
/// a wall is a matter of answers, not of stability. Each runs on one thread, on the kernel that a
/// plan picks for it. Throws PlanError.
std::vector<bool> run_trials(std::span<const Problem> problems, std::span<const std::int64_t> steps,
                             std::int64_t look_every, const IsGood& is_good,
                             const TrialOptions& options = {});

}  // namespace bounce
