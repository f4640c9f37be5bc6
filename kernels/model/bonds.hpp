// The neighbour list: compressed sparse rows, both directions of every bond, a class per entry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bounce {

/// Row i (start[i] .. start[i+1]) holds the neighbours of particle i, in the order in which the
/// listing sums their forces; that order fixes the rounding of the oracle and of `strict`.
struct BondList {
  std::vector<std::int64_t> start;       ///< particles + 1
  std::vector<std::int32_t> neighbour;   ///< one an entry
  std::vector<std::uint8_t> bond_class;  ///< one an entry; index into Problem::classes

  [[nodiscard]] std::size_t particles() const { return start.empty() ? 0 : start.size() - 1; }
  [[nodiscard]] std::size_t entries() const { return neighbour.size(); }
  [[nodiscard]] std::size_t bonds() const { return entries() / 2; }
};

/// Bonds of `rings` rings of `per_ring` particles each: next and previous on the ring, and the two
/// nearest on each adjacent ring (MODEL 1). Ring r has class 2r, rings r and r+1 have class 2r+1.
/// Entry order is the listing's, with its two irregular rows (particles 121 and 360) for three
/// rings.
BondList ring_bonds(int rings, std::int64_t per_ring);

/// Throws std::logic_error naming the particle if a neighbour is out of range, a particle is its
/// own neighbour or has a neighbour twice, or a bond lacks its other direction or has another class
/// there.
void check_bonds(const BondList& bonds);

}  // namespace bounce
