// Refuses a scene that memory cannot hold, before anything is allocated.
#pragma once

#include <cstddef>
#include <string>

#include "driver/scene/scene_file.hpp"
#include "kernels/model/scene.hpp"

namespace bounce {

/// Bytes that `bounce run` takes at its peak: the solver, and what looking at a state costs.
double run_bytes(const Scene& scene, const std::string& kernel);

/// Throws InputError naming file, key, value and what is allowed if a run of this scene takes more
/// than `available` bytes.
void check_memory(const SceneFile& file, const std::string& kernel, double available);

/// Throws InputError naming --every if three reference courses of so many particles, held whole at
/// so many times, take more than 2 GB.
void check_path_memory(std::size_t particles, double times);

}  // namespace bounce
