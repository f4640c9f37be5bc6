// From a scene file and an initial state to the numbers that are computed with.
#pragma once

#include <optional>
#include <string>

#include "driver/scene/scene_file.hpp"
#include "kernels/model/problem.hpp"

namespace bounce {

/// The state in the file `initial` (see read_state); nothing if that is "". It is to be read once:
/// the file may be a pipe.
std::optional<State> load_start(const std::string& initial);

/// make_problem, started from that state, if there is one. Throws InputError that names file, line,
/// key and value; also where the ball's start, rounded to four decimals, would strain its bonds by
/// more than 1 %.
Problem load_problem(const SceneFile& file, const std::optional<State>& start);

}  // namespace bounce
