// Scenes of the kinds of wall that the paper's examples do not have, for the equivalence check.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/model/scene.hpp"

namespace bounce {

struct WallScene {
  std::string name;
  Scene scene;
};

/// Ceilings, two walls, tilted and upright ones, alpha and beta between their ends, starts on a
/// wall and behind it: the paper's ball within 0.003 cm of its walls and moving at 2 cm/s, so that
/// each is met within wall_scene_steps. Each kind once so that left and right are alike, where that
/// can be, so that the kernel of half balls has it, too.
std::vector<WallScene> wall_scenes();

/// Steps after which each of these scenes has met its walls.
inline constexpr std::int64_t wall_scene_steps = 4000;

}  // namespace bounce
