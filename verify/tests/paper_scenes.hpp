// The paper's examples as plain data, so that these tests need no scene files.
#pragma once

#include <cmath>
#include <string>

#include "kernels/model/scene.hpp"

namespace bounce {

/// Example 1 to 7 of the paper.
inline Scene paper_scene(int example) {
  Scene scene;
  scene.title = "Example " + std::to_string(example);
  scene.law.elasticity = example == 1 || example == 3 ? 1000.0 : 16000.0;
  const bool heavy = example == 3 || example == 4;
  scene.gravity = {0.0, heavy ? -0.98 : -0.098};
  scene.ball.centre = {0.0, heavy ? 15.0 : 10.0};
  if (example == 5 || example == 6) scene.ball.velocity = {4.0, 0.0};
  Wall floor;
  if (example >= 6) floor.alpha = 1.0;
  if (example >= 6) floor.beta = -1.0;
  if (example == 7) {
    scene.ball.centre.x = 7.0 * std::sqrt(2.0) - 10.0;
    Wall incline = floor;
    incline.normal = {std::sqrt(0.5), std::sqrt(0.5)};
    scene.walls.push_back(incline);
  }
  scene.walls.push_back(floor);
  return scene;
}

}  // namespace bounce
