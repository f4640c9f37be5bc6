// Who is bound to whom: any list, or rings, of which no list is needed.
//
// The neighbours in a ball of rings follow from two numbers, and each row of its list can be
// computed in a few nanoseconds; a list of it takes 32 bytes a particle, as much as its state. So
// rings keep the two numbers, and code that reads row by row (visit_row) needs no more. Code that
// wants a BondList gets one: it is built when first asked for and then shared by all copies.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "kernels/model/bonds.hpp"

namespace bounce {

class Neighbours {
 public:
  /// Of no particles.
  Neighbours();
  /// Any list. Implicit: a list is a neighbourhood.
  Neighbours(BondList list);  // NOLINT(google-explicit-constructor)
  /// Those of ring_bonds(rings, per_ring), without a list.
  static Neighbours of_rings(int rings, std::int64_t per_ring);

  [[nodiscard]] std::size_t particles() const;
  [[nodiscard]] std::size_t entries() const;
  [[nodiscard]] std::size_t bonds() const { return entries() / 2; }
  [[nodiscard]] std::size_t row_length(std::size_t i) const;

  /// Calls visit(neighbour, class), both as std::size_t, for each entry of row i, in its order.
  template <class Visit>
  void visit_row(std::size_t i, const Visit& visit) const {
    if (rings_) {
      const auto particle = static_cast<std::int64_t>(i);
      for (const BondEntry& entry : ring_row(rings_->rings, rings_->per_ring, particle)) {
        visit(static_cast<std::size_t>(entry.neighbour),
              static_cast<std::size_t>(entry.bond_class));
      }
      return;
    }
    const BondList& bonds = shared_->list;
    const auto end = static_cast<std::size_t>(bonds.start[i + 1]);
    for (auto e = static_cast<std::size_t>(bonds.start[i]); e < end; ++e) {
      visit(static_cast<std::size_t>(bonds.neighbour[e]),
            static_cast<std::size_t>(bonds.bond_class[e]));
    }
  }

  /// Calls visit(i, j, class) for each bond once, i < j, row by row. A small ball keeps these
  /// bonds, from the first call on: a monitor asks for them three times a sample.
  template <class Visit>
  void for_each_bond(const Visit& visit) const {
    if (particles() <= most_kept) {
      for (const Bond& bond : kept_bonds()) visit(bond.i, bond.j, bond.bond_class);
      return;
    }
    for (std::size_t i = 0; i < particles(); ++i) {
      visit_row(i, [&](std::size_t j, std::size_t bond_class) {
        if (j > i) visit(i, j, bond_class);
      });
    }
  }

  /// What of_rings was given; nothing if this is a list, be it one of rings.
  struct Rings {
    int rings = 0;
    std::int64_t per_ring = 0;
    bool operator==(const Rings&) const = default;
  };
  [[nodiscard]] const std::optional<Rings>& rings() const { return rings_; }

  /// As a list; of rings it is built at the first call. Any thread may ask.
  [[nodiscard]] const BondList& list() const;
  operator const BondList&() const { return list(); }  // NOLINT(google-explicit-constructor)

  /// The same rows in the same order.
  bool operator==(const Neighbours& other) const;

 private:
  struct Bond {
    std::uint32_t i, j, bond_class;
  };
  // Some 36 bytes a particle: as much as a core's second-level cache holds.
  static constexpr std::size_t most_kept = 20000;
  [[nodiscard]] const std::vector<Bond>& kept_bonds() const;

  struct Shared {
    std::once_flag once, bonds_once;
    BondList list;
    std::vector<Bond> bonds;
  };

  std::optional<Rings> rings_;
  std::shared_ptr<Shared> shared_;  // of rings: empty until list() is called
};

}  // namespace bounce
