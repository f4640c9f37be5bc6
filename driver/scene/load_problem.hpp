// From a scene file and an initial state to the numbers that are computed with.
#pragma once

#include <string>

#include "driver/scene/scene_file.hpp"
#include "kernels/model/problem.hpp"

namespace bounce {

/// make_problem, started from the state in the file `initial` (see read_state) unless that is "".
/// Throws InputError that names file, line, key and value.
Problem load_problem(const SceneFile& file, const std::string& initial);

}  // namespace bounce
