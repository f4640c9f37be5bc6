// What holds of a scene that was read, whatever it was read from.
#pragma once

#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_file.hpp"
#include "kernels/model/ball.hpp"
#include "verify/tests/fuzz/fuzz_target.hpp"

namespace bounce {

/// Writes it, reads that back, and, if it is small, makes its problem.
inline void use_scene(const SceneFile& file) {
  constexpr std::size_t small = 2000;  // particles: some kB, below a millisecond
  const Scene scene = file.scene();
  const std::string text = to_toml(scene);
  const Scene again = SceneFile::parse(text, "again").scene();
  must_hold(again == scene, "a scene that is written reads back the same");
  must_hold(to_toml(again) == text, "and is written the same");
  if (ball_size(scene.ball).particles > small) return;
  const Problem problem = load_problem(file, std::nullopt);
  must_hold(problem.initial.size() == ball_size(scene.ball).particles, "a ball has its size");
}

}  // namespace bounce
