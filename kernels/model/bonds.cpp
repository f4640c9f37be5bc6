#include "kernels/model/bonds.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace bounce {
namespace {

struct Entry {
  std::int64_t neighbour;
  int bond_class;
};

// A row of the list: at most six neighbours (two on the ring, two on each adjacent ring).
class Row {
 public:
  void add(std::int64_t neighbour, int bond_class) { entries_[size_++] = {neighbour, bond_class}; }
  void swap(std::size_t a, std::size_t b) { std::swap(entries_[a], entries_[b]); }
  [[nodiscard]] auto begin() const { return entries_.begin(); }
  [[nodiscard]] auto end() const { return entries_.begin() + size_; }

 private:
  std::array<Entry, 6> entries_{};
  int size_ = 0;
};

// Neighbours of one particle in the listing's order: a ring between two others starts with the
// inner ring, an outermost or innermost ring with its own; the same column stands before the other
// one.
Row make_row(int rings, std::int64_t per_ring, int ring, std::int64_t column) {
  const auto at = [per_ring](int r, std::int64_t c) {
    return r * per_ring + (c + per_ring) % per_ring;
  };
  // A staggered ring's particle lies between its column and the next one of the rings beside it.
  const std::int64_t other = ring % 2 == 1 ? column + 1 : column - 1;
  const auto add_own = [&](Row& row) {
    row.add(at(ring, column + 1), 2 * ring);
    row.add(at(ring, column - 1), 2 * ring);
  };
  const auto add_beside = [&](Row& row, int beside) {
    row.add(at(beside, column), ring + beside);  // class 2r + 1 between rings r and r + 1
    row.add(at(beside, other), ring + beside);
  };
  Row row;
  const bool outermost = ring + 1 == rings;
  if (ring == 0 || outermost) add_own(row);
  if (ring > 0) add_beside(row, ring - 1);
  if (ring > 0 && !outermost) add_own(row);
  if (!outermost) add_beside(row, ring + 1);
  // The two rows that the listing writes out of order (MODEL 3): particles 121 and 360.
  if (rings == 3 && ring == 1 && column == 0) row.swap(4, 5);
  if (rings == 3 && ring == 2 && column == per_ring - 1) row.swap(0, 1);
  return row;
}

std::string particle_name(std::size_t i) { return "particle " + std::to_string(i + 1); }

void check_entry(const BondList& bonds, std::size_t i, std::int64_t entry) {
  const auto e = static_cast<std::size_t>(entry);
  const std::int64_t j = bonds.neighbour[e];
  if (j < 0 || j >= static_cast<std::int64_t>(bonds.particles())) {
    throw std::logic_error(particle_name(i) + " has a neighbour out of range");
  }
  if (j == static_cast<std::int64_t>(i)) {
    throw std::logic_error(particle_name(i) + " is its own neighbour");
  }
  int back = 0;
  int again = 0;
  const auto row = static_cast<std::size_t>(j);
  for (std::int64_t f = bonds.start[row]; f < bonds.start[row + 1]; ++f) {
    const auto g = static_cast<std::size_t>(f);
    if (bonds.neighbour[g] == static_cast<std::int64_t>(i) &&
        bonds.bond_class[g] == bonds.bond_class[e]) {
      ++back;
    }
  }
  for (std::int64_t f = bonds.start[i]; f < bonds.start[i + 1]; ++f) {
    if (bonds.neighbour[static_cast<std::size_t>(f)] == j) ++again;
  }
  if (again != 1) {
    throw std::logic_error(particle_name(i) + " has " + particle_name(row) + " as neighbour twice");
  }
  if (back != 1) {
    throw std::logic_error("the bond from " + particle_name(i) + " to " + particle_name(row) +
                           " lacks its other direction, or has another class there");
  }
}

}  // namespace

BondList ring_bonds(int rings, std::int64_t per_ring) {
  BondList bonds;
  const auto particles = static_cast<std::size_t>(rings * per_ring);
  const std::size_t entries = 2 * (2 * particles + particles / static_cast<std::size_t>(rings) *
                                                       static_cast<std::size_t>(rings - 1));
  bonds.start.reserve(particles + 1);
  bonds.neighbour.reserve(entries);
  bonds.bond_class.reserve(entries);
  bonds.start.push_back(0);
  for (int ring = 0; ring < rings; ++ring) {
    for (std::int64_t column = 0; column < per_ring; ++column) {
      for (const Entry& entry : make_row(rings, per_ring, ring, column)) {
        bonds.neighbour.push_back(static_cast<std::int32_t>(entry.neighbour));
        bonds.bond_class.push_back(static_cast<std::uint8_t>(entry.bond_class));
      }
      bonds.start.push_back(static_cast<std::int64_t>(bonds.neighbour.size()));
    }
  }
  return bonds;
}

void check_bonds(const BondList& bonds) {
  const auto entries = static_cast<std::int64_t>(bonds.entries());
  if (bonds.start.empty() || bonds.start.front() != 0 || bonds.start.back() != entries ||
      bonds.bond_class.size() != bonds.entries() ||
      !std::is_sorted(bonds.start.begin(), bonds.start.end())) {
    throw std::logic_error("the rows of the neighbour list do not fit its entries");
  }
  for (std::size_t i = 0; i < bonds.particles(); ++i) {
    for (std::int64_t e = bonds.start[i]; e < bonds.start[i + 1]; ++e) check_entry(bonds, i, e);
  }
}

}  // namespace bounce
