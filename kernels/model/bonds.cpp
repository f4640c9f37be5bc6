#include "kernels/model/bonds.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace bounce {
namespace {

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

// Neighbours of one particle in the listing's order: a ring between two others starts with the
// inner ring, an outermost or innermost ring with its own; the same column stands before the other
// one.
RingRow ring_row(int rings, std::int64_t per_ring, std::int64_t particle) {
  const auto ring = static_cast<int>(particle / per_ring);
  const std::int64_t column = particle % per_ring;
  const auto at = [per_ring](int r, std::int64_t c) {  // c is at most one off
    return r * per_ring + (c < 0 ? c + per_ring : c < per_ring ? c : c - per_ring);
  };
  // A staggered ring's particle lies between its column and the next one of the rings beside it.
  const std::int64_t other = ring % 2 == 1 ? column + 1 : column - 1;
  const auto add_own = [&](RingRow& row) {
    row.add(at(ring, column + 1), 2 * ring);
    row.add(at(ring, column - 1), 2 * ring);
  };
  const auto add_beside = [&](RingRow& row, int beside) {
    row.add(at(beside, column), ring + beside);  // class 2r + 1 between rings r and r + 1
    row.add(at(beside, other), ring + beside);
  };
  RingRow row;
  const bool outermost = ring + 1 == rings;
  if (ring == 0 || outermost) add_own(row);
  if (ring > 0) add_beside(row, ring - 1);
  if (ring > 0 && !outermost) add_own(row);
  if (!outermost) add_beside(row, ring + 1);
  // The two rows that the listing writes out of order: particles 121 and 360.
  if (rings == 3 && ring == 1 && column == 0) row.swap(4, 5);
  if (rings == 3 && ring == 2 && column == per_ring - 1) row.swap(0, 1);
  return row;
}

std::size_t ring_entries(int rings, std::int64_t per_ring) {
  return static_cast<std::size_t>(per_ring) * static_cast<std::size_t>(6 * rings - 4);
}

BondList ring_bonds(int rings, std::int64_t per_ring) {
  BondList bonds;
  const auto particles = static_cast<std::size_t>(rings * per_ring);
  const std::size_t entries = ring_entries(rings, per_ring);
  bonds.start.reserve(particles + 1);
  bonds.neighbour.reserve(entries);
  bonds.bond_class.reserve(entries);
  bonds.start.push_back(0);
  for (std::size_t i = 0; i < particles; ++i) {
    for (const BondEntry& entry : ring_row(rings, per_ring, static_cast<std::int64_t>(i))) {
      bonds.neighbour.push_back(static_cast<std::int32_t>(entry.neighbour));
      bonds.bond_class.push_back(static_cast<std::uint16_t>(entry.bond_class));
    }
    bonds.start.push_back(static_cast<std::int64_t>(bonds.neighbour.size()));
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
