// The neighbour list cut for vectors: slices of `lanes` consecutive particles, one column of
// entries a neighbour position (a sliced ELLPACK of the CSR rows, in their order).
//
//   particle:    i    i+1   i+2   i+3        an entry = one neighbour position of the slice:
//   entry 0:   i+1   i+2   i+3   i+4            consecutive neighbours: their first index, one load
//   entry 1:   i+n   i+n+1 i+n+2 i+n+3          others: a place in `scattered`, one gather
//   entry 2:   i-1   (none) i+1  i+2            lanes without this neighbour name themselves
//
// Entries [0, full) exist in every lane, [full, all) in some. `combination` names the classes of
// the lanes: there are few different ones, so the constants of an entry are two loads from a small
// table.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/model/neighbours.hpp"
#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// One neighbour position of a slice.
struct SliceEntry {
  std::int32_t first;  ///< >= 0: neighbours first, first + 1, ...; < 0: -1 - (place in scattered)
  std::int32_t combination;  ///< row of `combinations`
};

/// Where the entries of one slice stand.
struct Slice {
  std::int64_t begin = 0;
  std::int32_t full = 0;  ///< entries that every lane has
  std::int32_t all = 0;   ///< entries that some lane has
};

inline constexpr int no_bond = -1;

/// Of a stepper of slices, at least four lanes wide: positions twice and velocities, a Slice for
/// four particles, a SliceEntry for four entries. (Scattered neighbours take 8 bytes an entry more;
/// in rings and lattices they are few.)
inline constexpr StepperMemory sliced_memory{.a_particle = 48.0 + 16.0 / 4, .an_entry = 8.0 / 4};

struct SlicedBonds {
  int lanes = 0;
  std::vector<Slice> slices;
  std::vector<SliceEntry> entries;
  std::vector<std::int64_t> scattered;  ///< neighbours, `lanes` a place
  std::vector<int> combinations;        ///< classes or no_bond, `lanes` a row

  [[nodiscard]] std::size_t combination_count() const {
    return combinations.size() / static_cast<std::size_t>(lanes);
  }
};

/// Reads row by row: no list is made of rings.
SlicedBonds slice_bonds(const Neighbours& bonds, int lanes);

}  // namespace bounce
