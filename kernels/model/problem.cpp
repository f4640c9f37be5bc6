#include "kernels/model/problem.hpp"

#include <cmath>

#include "kernels/model/ball.hpp"
#include "kernels/model/method.hpp"

namespace bounce {
namespace {

// A particle that four decimals have put behind a wall is let in; one that is deeper is not.
constexpr double rounding_depth = 1e-4;  // cm

double stored(Constants constants, double value) {
  return constants == Constants::single_precision ? single_literal(value) : value;
}

std::vector<BondClass> bond_classes(const Scene& scene) {
  std::vector<BondClass> classes;
  const double half_gap = 0.5 * (scene.law.q - scene.law.p);
  for (const double r2 : rest_lengths_squared(scene.ball, scene.law.rest)) {
    // R0^(q-p) from R0^2; for the paper's q - p = 2 it is R0^2 itself, as the author multiplied it.
    const double power = half_gap == 1.0 ? r2 : std::pow(r2, half_gap);
    classes.push_back({stored(scene.constants, scene.law.elasticity),
                       stored(scene.constants, scene.law.elasticity * power), std::sqrt(r2)});
    const BondClass& bond = classes.back();
    if (!(bond.attraction > 0.0 && bond.repulsion > 0.0 && std::isfinite(bond.repulsion))) {
      throw SceneError("law.elasticity", std::to_string(scene.law.elasticity),
                       "a value for which E and E R0^(q-p) stay finite and above 0 as they are "
                       "stored (constants = single or double)");
    }
  }
  return classes;
}

void check_start(const Scene& scene, const Problem& problem) {
  if (!is_finite(problem.initial)) {
    throw SceneError("initial state", "a value that is not finite",
                     "finite positions and velocities");
  }
  for (std::size_t w = 0; w < problem.walls.size(); ++w) {
    for (std::size_t i = 0; i < problem.initial.size(); ++i) {
      const double d = wall_distance(problem.walls[w], problem.initial.x[i], problem.initial.y[i]);
      if (!(d >= -rounding_depth)) {
        throw SceneError("wall[" + std::to_string(w) + "]",
                         "a wall that particle " + std::to_string(i + 1) + " starts " +
                             std::to_string(-d) + " cm behind",
                         "walls that the whole ball starts in front of (centre " +
                             std::to_string(scene.ball.centre.x) + ", " +
                             std::to_string(scene.ball.centre.y) + ")");
      }
    }
  }
}

}  // namespace

double single_literal(double value) {
  // volatile: GCC 12 at -O2 turns two such conversions side by side into a vector one and then
  // drops it, leaving the double unrounded.
  const volatile auto narrow = static_cast<float>(value);
  return static_cast<double>(narrow);
}

double wall_distance(const Wall& wall, double x, double y) {
  return wall.normal.x * x + wall.normal.y * y - wall.offset;
}

Problem make_problem(const Scene& scene, const std::optional<State>& initial) {
  validate(scene);
  Problem problem;
  problem.law = {scene.law.p, scene.law.q};
  problem.classes = bond_classes(scene);
  problem.gravity = {stored(scene.constants, scene.gravity.x),
                     stored(scene.constants, scene.gravity.y)};
  problem.step = stored(scene.constants, scene.time.step);
  if (!(problem.step > 0.0)) {
    throw SceneError("time.step", std::to_string(scene.time.step), "above 0 in single precision");
  }
  problem.walls = scene.walls;
  for (Wall& wall : problem.walls) {
    const double length = std::hypot(wall.normal.x, wall.normal.y);
    wall.normal = {wall.normal.x / length, wall.normal.y / length};
  }
  problem.method = find_method(scene.time.method);
  const std::size_t particles = ball_size(scene.ball).particles;
  if (initial && initial->size() != particles) {
    throw SceneError("initial state", std::to_string(initial->size()) + " particles",
                     std::to_string(particles) + " particles, as the scene's ball has");
  }
  problem.initial = initial ? *initial : make_ball(scene.ball);
  check_start(scene, problem);
  problem.bonds = ball_neighbours(scene.ball);
  return problem;
}

}  // namespace bounce
