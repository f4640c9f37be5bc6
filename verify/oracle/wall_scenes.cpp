#include "verify/oracle/wall_scenes.hpp"

#include <utility>

namespace bounce {
namespace {

constexpr double radius = 7.0;    // cm, of the outer ring
constexpr double gap = 0.002;     // cm: a thousand steps of 1e-6 s at the ball's speed
constexpr double speed = 2.0;     // cm/s
constexpr double behind = -5e-5;  // cm: met at once; starts may be 1e-4 cm behind a wall
constexpr Vec2 centre{0.0, 10.0};

// The ball in front of that wall and moving towards it, and along it as fast as `along`.
Scene towards(Vec2 normal, double alpha, double beta, double along = 0.0, double distance = gap) {
  Scene scene;
  scene.ball.centre = centre;
  scene.ball.velocity = {-speed * normal.x + along * normal.y,
                         -speed * normal.y - along * normal.x};
  const double offset = normal.x * centre.x + normal.y * centre.y - radius - distance;
  scene.walls = {Wall{normal, offset, alpha, beta}};
  return scene;
}

// Another wall, at that distance.
Scene with_wall(Scene scene, Vec2 normal, double alpha, double beta, double distance = gap) {
  scene.walls.push_back(towards(normal, alpha, beta, 0.0, distance).walls.front());
  return scene;
}

// The paper's ball with its lowest particle at that height over the X axis: on it, or as far behind
// as four decimals can put it.
Scene on_the_floor(double height, double alpha, double beta, double along) {
  Scene scene = towards({0.0, 1.0}, alpha, beta, along);
  scene.ball.centre.y = radius + height;
  scene.walls.front().offset = 0.0;
  return scene;
}

}  // namespace

std::vector<WallScene> wall_scenes() {
  const Vec2 up{0.0, 1.0}, down{0.0, -1.0}, left{-1.0, 0.0}, right{1.0, 0.0};
  const Vec2 slope{0.6, 0.8}, back_slope{-0.6, 0.8}, overhang{0.8, -0.6};
  return {
      {"ceiling", towards(down, 0.0, 0.0)},
      {"ceiling, half elastic", towards(down, 0.3, -0.6, 1.0)},
      {"floor, half elastic", towards(up, 0.7, -0.4, 1.0)},
      {"floor and ceiling", with_wall(towards(up, 0.25, -0.75), down, 0.5, -0.5, behind)},
      {"side wall", towards(right, 0.4, -0.9, -1.0)},
      {"side walls", with_wall(towards(left, 1.0, -0.5), right, 0.0, -1.0, behind)},
      {"slope", towards(slope, 0.8, -0.3)},
      {"overhang", towards(overhang, 0.1, -0.2, 1.0)},
      {"wedge", with_wall(towards(up, 0.6, -0.1), slope, 0.9, -0.8)},
      {"valley", with_wall(towards(slope, 0.5, -0.2, 1.5), back_slope, 0.5, -0.2)},
      {"on the floor", on_the_floor(0.0, 0.5, -0.5, 0.0)},
      {"on the floor, moving", on_the_floor(0.0, 0.2, 0.0, 1.0)},
      {"behind the floor", on_the_floor(-1e-4, 0.6, -0.7, 0.0)},
      {"behind an elastic floor", on_the_floor(-1e-4, 0.5, -1.0, 1.0)},
  };
}

}  // namespace bounce
