#include "kernels/rings/ring_shape.hpp"

namespace bounce {
namespace {

constexpr int unknown = -1;

// Class of the bond i-j, or unknown if there is none.
int class_between(const BondList& bonds, std::int64_t i, std::int64_t j) {
  const auto row = static_cast<std::size_t>(i);
  for (std::int64_t e = bonds.start[row]; e < bonds.start[row + 1]; ++e) {
    const auto entry = static_cast<std::size_t>(e);
    if (bonds.neighbour[entry] == j) return bonds.bond_class[entry];
  }
  return unknown;
}

// One family of bonds, column by column: all there, all of one class; else unknown.
int family_class(const BondList& bonds, std::int64_t per_ring, std::int64_t from_ring,
                 std::int64_t to_ring, std::int64_t shift) {
  int found = unknown;
  for (std::int64_t k = 0; k < per_ring; ++k) {
    const int here =
        class_between(bonds, from_ring * per_ring + k, to_ring * per_ring + (k + shift) % per_ring);
    if (here == unknown || (k > 0 && here != found)) return unknown;
    found = here;
  }
  return found;
}

std::optional<RingShape> match(const BondList& bonds, int rings) {
  const auto particles = static_cast<std::int64_t>(bonds.particles());
  RingShape shape;
  shape.rings = rings;
  shape.per_ring = particles / rings;
  const std::int64_t families = 3 * rings - 2;
  if (static_cast<std::int64_t>(bonds.bonds()) != families * shape.per_ring) return std::nullopt;
  for (int r = 0; r < rings; ++r) {
    shape.along.push_back(family_class(bonds, shape.per_ring, r, r, 1));
    if (shape.along.back() == unknown) return std::nullopt;
    if (r + 1 == rings) break;
    const int staggered = r % 2 == 1 ? r : r + 1;
    const int plain = r % 2 == 1 ? r + 1 : r;
    shape.same.push_back(family_class(bonds, shape.per_ring, r, r + 1, 0));
    shape.diagonal.push_back(family_class(bonds, shape.per_ring, staggered, plain, 1));
    if (shape.same.back() == unknown || shape.diagonal.back() == unknown) return std::nullopt;
  }
  return shape;
}

// As ring_row numbers classes.
RingShape shape_of(const Neighbours::Rings& known) {
  RingShape shape{known.rings, known.per_ring, {}, {}, {}};
  for (int r = 0; r < known.rings; ++r) {
    shape.along.push_back(2 * r);
    if (r + 1 == known.rings) break;
    shape.same.push_back(2 * r + 1);
    shape.diagonal.push_back(2 * r + 1);
  }
  return shape;
}

}  // namespace

std::optional<RingShape> find_rings(const Neighbours& neighbours, int most) {
  if (const auto& known = neighbours.rings()) {
    if (known->rings > most) return std::nullopt;
    return shape_of(*known);
  }
  const BondList& bonds = neighbours.list();
  const auto particles = static_cast<std::int64_t>(bonds.particles());
  for (int rings = 1; rings <= most; ++rings) {
    if (particles % rings != 0 || particles / rings < 3) continue;
    if (auto shape = match(bonds, rings)) return shape;
  }
  return std::nullopt;
}

}  // namespace bounce
