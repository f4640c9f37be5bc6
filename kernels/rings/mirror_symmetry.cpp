#include "kernels/rings/mirror_symmetry.hpp"

namespace bounce {
namespace {

bool is_image(const State& state, std::size_t i, std::size_t j) {
  return state.x[i] == -state.x[j] && state.y[i] == state.y[j];
}

bool moves_as_image(const State& state, std::size_t i, std::size_t j) {
  return state.vx[i] == -state.vx[j] && state.vy[i] == state.vy[j];
}

}  // namespace

std::string not_symmetric(const State& state, const RingShape& shape, std::int64_t sum) {
  for (int ring = 0; ring < shape.rings; ++ring) {
    for (std::int64_t k = 0; k < shape.per_ring; ++k) {
      const std::int64_t first = ring * shape.per_ring;
      const auto i = static_cast<std::size_t>(first + k);
      const auto j = static_cast<std::size_t>(first + mirror_image(shape, sum, ring, k));
      const bool image = is_image(state, i, j);
      if (image && moves_as_image(state, i, j)) continue;
      return "particles " + std::to_string(i + 1) + " and " + std::to_string(j + 1) +
             " are not mirror images about x = 0" + (image ? " in their velocities" : "");
    }
  }
  return {};
}

void make_symmetric(const RingShape& shape, std::int64_t sum, State& state) {
  for (int ring = 0; ring < shape.rings; ++ring) {
    for (std::int64_t k = 0; k < shape.per_ring; ++k) {
      const std::int64_t image = mirror_image(shape, sum, ring, k);
      if (image < k) continue;
      const auto i = static_cast<std::size_t>(ring * shape.per_ring + k);
      const auto j = static_cast<std::size_t>(ring * shape.per_ring + image);
      state.x[j] = i == j ? 0.0 : -state.x[i];
      state.y[j] = state.y[i];
      state.vx[j] = i == j ? 0.0 : -state.vx[i];
      state.vy[j] = state.vy[i];
    }
  }
}

MirrorAxis find_mirror_axis(const Problem& problem, const RingShape& shape) {
  if (problem.gravity.x != 0.0) return {0, "gravity has an x component"};
  for (const Wall& wall : problem.walls) {
    if (wall.normal.x != 0.0) return {0, "a wall is not horizontal"};
  }
  if (shape.per_ring % 2 != 0) return {0, "its number of columns is odd"};
  // Particle 1's image is on its ring: the first one with its place mirrored decides.
  const State& start = problem.initial;
  for (std::int64_t sum = 0; sum < shape.per_ring; sum += 2) {
    if (!is_image(start, 0, static_cast<std::size_t>(mirror_image(shape, sum, 0, 0)))) continue;
    return {sum, not_symmetric(start, shape, sum)};
  }
  return {0, "particle 1 has no mirror image about x = 0"};
}

}  // namespace bounce
