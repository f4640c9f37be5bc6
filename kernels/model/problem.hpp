// The numbers a simulation computes with. Every kernel, the oracle apart, starts from a Problem.
#pragma once

#include <optional>
#include <vector>

#include "kernels/model/neighbours.hpp"
#include "kernels/model/pair_law.hpp"
#include "kernels/model/scene.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

struct Method;

/// What acts on the particles: small, whatever the ball's size, but for a list of bonds, which
/// copies share.
struct Model {
  Neighbours bonds;
  PairLaw law;
  std::vector<BondClass> classes;
  Vec2 gravity;  ///< cm/s^2
  std::vector<Wall> walls;
  double step = 0.0;  ///< s
  const Method* method = nullptr;
};

/// A scene made ready: constants rounded as the scene says, ball built.
struct Problem : Model {
  State initial;
};

/// Rounds to single precision and widens again, as FORTRAN does with a literal without exponent D.
double single_literal(double value);

/// Signed distance of a point from a wall, cm; positive = where the ball may be.
double wall_distance(const Wall& wall, double x, double y);

/// Validates the scene, builds the ball, bonds and constants. `initial` replaces the ball's own
/// start (same number of particles). Throws SceneError, also when a particle starts behind a wall
/// by more than the 1e-4 cm that four decimals can hide. A ball of rings gets no list of bonds: per
/// particle 32 bytes, its state.
Problem make_problem(const Scene& scene, const std::optional<State>& initial = std::nullopt);

}  // namespace bounce
