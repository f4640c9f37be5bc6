// Positions and velocities of all particles, in the listing's numbering: ring by ring outwards,
// counter-clockwise on each ring. Index 0 here is particle 1 of the paper.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bounce {

/// cm and cm/s; four arrays of the same length.
struct State {
  std::vector<double> x, y, vx, vy;

  State() = default;
  explicit State(std::size_t particles)
      : x(particles), y(particles), vx(particles), vy(particles) {}
  [[nodiscard]] std::size_t size() const { return x.size(); }
};

/// True if every number of the state is finite.
bool is_finite(const State& state);

/// FNV-1a over the bits of x, y, vx, vy, in this order: two states have the same hash if and (but
/// for a chance of 2^-64) only if they are the same to the last bit.
std::uint64_t state_hash(const State& state);

}  // namespace bounce
