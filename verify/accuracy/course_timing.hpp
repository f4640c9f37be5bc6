// How long courses take on the kernels that run them: by turns, one kernel at a time, without
// output.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernels/stepping/stepper.hpp"
#include "verify/accuracy/accuracy.hpp"

namespace bounce {

/// Median seconds of a step of each stepper, from `turns` turns in which each in its turn steps for
/// some `slice` seconds from its present state, to which it is put back after each turn. Cores
/// change their clock: only ratios of times from one call mean anything.
std::vector<double> time_steps(std::span<Stepper* const> steppers, int turns = 15,
                               double slice = 2e-3);

/// Seconds on one thread.
struct CourseTimes {
  std::vector<double> rows;  ///< of each row's whole course; NaN if none of its kind stayed finite
  double oracle = 0.0;  ///< of a step of the oracle; 0: not asked for, or it cannot run the scene
};

/// Times a step of each method and contact of the rows, in flight and where the ball is lowest, and
/// takes them by the share of the course that is contact. With located contact whole courses of
/// each method are timed.
CourseTimes time_courses(const Scene& scene, const std::optional<State>& initial,
                         const Sampling& sampling, std::span<const AccuracyRow> rows,
                         bool with_oracle, int turns = 15);

}  // namespace bounce
