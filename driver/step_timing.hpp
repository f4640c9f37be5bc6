// How long a step takes on the kernel that runs it: by turns, one kernel at a time, without output.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// Median seconds of a step of each stepper, from `turns` turns in which each in its turn steps for
/// some `slice` seconds from its present state, to which it is put back after each turn. Cores
/// change their clock: only ratios of times from one call mean anything.
std::vector<double> time_steps(std::span<Stepper* const> steppers, int turns = 15,
                               double slice = 2e-3);

}  // namespace bounce
