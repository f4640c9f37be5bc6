// The neighbour list: compressed sparse rows, both directions of every bond, a class per entry.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace bounce {

/// Row i (start[i] .. start[i+1]) holds the neighbours of particle i, in the order in which the
/// listing sums their forces; that order fixes the rounding of the oracle and of `strict`. Indices
/// of 32 bits name 2^31 - 1 particles; validate lets fewer through.
struct BondList {
  std::vector<std::int64_t> start;        ///< particles + 1
  std::vector<std::int32_t> neighbour;    ///< one an entry
  std::vector<std::uint16_t> bond_class;  ///< one an entry; index into Problem::classes

  [[nodiscard]] std::size_t particles() const { return start.empty() ? 0 : start.size() - 1; }
  [[nodiscard]] std::size_t entries() const { return neighbour.size(); }
  [[nodiscard]] std::size_t bonds() const { return entries() / 2; }
  bool operator==(const BondList&) const = default;
};

/// Bytes of a list.
constexpr std::size_t bond_list_bytes(std::size_t particles, std::size_t entries) {
  return sizeof(std::int64_t) * (particles + 1) +
         (sizeof(std::int32_t) + sizeof(std::uint16_t)) * entries;
}

/// One entry of a row.
struct BondEntry {
  std::int64_t neighbour;
  int bond_class;
};

/// A row of a ball of rings: at most six neighbours (two on the ring, two on each adjacent ring).
class RingRow {
 public:
  void add(std::int64_t neighbour, int bond_class) { entries_[size_++] = {neighbour, bond_class}; }
  void swap(std::size_t a, std::size_t b) { std::swap(entries_[a], entries_[b]); }
  [[nodiscard]] const BondEntry* begin() const { return entries_.data(); }
  [[nodiscard]] const BondEntry* end() const { return entries_.data() + size_; }

 private:
  std::array<BondEntry, 6> entries_{};
  std::size_t size_ = 0;
};

/// Row `particle` of ring_bonds(rings, per_ring).
RingRow ring_row(int rings, std::int64_t per_ring, std::int64_t particle);

/// Entries of ring_bonds(rings, per_ring).
std::size_t ring_entries(int rings, std::int64_t per_ring);

/// Bonds of `rings` rings of `per_ring` particles each: next and previous on the ring, and the two
/// nearest on each adjacent ring (paper, section 2). Ring r has class 2r, rings r and r+1 have
/// class 2r+1. Entry order is the listing's, with its two irregular rows (particles 121 and 360)
/// for three rings.
BondList ring_bonds(int rings, std::int64_t per_ring);

/// Throws std::logic_error naming the particle if a neighbour is out of range, a particle is its
/// own neighbour or has a neighbour twice, or a bond lacks its other direction or has another class
/// there.
void check_bonds(const BondList& bonds);

}  // namespace bounce
