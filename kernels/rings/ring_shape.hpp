// Finds out whether a neighbour list is concentric rings with constant offsets.
#pragma once

#include <optional>
#include <vector>

#include "kernels/model/neighbours.hpp"

namespace bounce {

/// Most rings the ring kernel is compiled for.
inline constexpr int most_rings = 4;
/// As many as a scene may have.
inline constexpr int any_rings = 1000;

/// Rings with the same number of columns, every other one staggered. Bonds of column k: along ring
/// r to column k + 1; between rings r and r + 1 within column k; and from the staggered one of the
/// two at column k to the other at column k + 1. Each of these families has one class.
struct RingShape {
  int rings = 0;
  std::int64_t per_ring = 0;
  std::vector<int> along;     ///< class, by ring
  std::vector<int> same;      ///< class, by inner ring of the pair
  std::vector<int> diagonal;  ///< class, by inner ring of the pair
};

/// The shape of the list, whatever the order of its rows' entries; nothing if it is no such list of
/// 1 to `most` rings. Of a Neighbours::of_rings the shape is known and nothing is read.
std::optional<RingShape> find_rings(const Neighbours& bonds, int most = most_rings);

}  // namespace bounce
