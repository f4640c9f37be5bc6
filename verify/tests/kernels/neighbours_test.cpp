// The rows of neighbours, computed or listed.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/model/bonds.hpp"
#include "kernels/model/neighbours.hpp"

namespace bounce {
namespace {

// Rows that are computed are the rows of the list; the list is built once, for all copies.
TEST(Neighbours, OfRingsAreTheListWithoutIt) {
  for (const int rings : {1, 2, 3, 4, 7}) {
    for (const std::int64_t per_ring : {3, 4, 120}) {
      const Neighbours computed = Neighbours::of_rings(rings, per_ring);
      const Neighbours listed = ring_bonds(rings, per_ring);
      EXPECT_FALSE(listed.rings());
      ASSERT_EQ(computed.particles(), listed.particles());
      EXPECT_EQ(computed.entries(), listed.entries());
      EXPECT_EQ(computed.bonds(), listed.bonds());
      for (std::size_t i = 0; i < listed.particles(); ++i) {
        EXPECT_EQ(computed.row_length(i), listed.row_length(i)) << i;
        const BondList& list = listed;
        auto e = static_cast<std::size_t>(list.start[i]);
        computed.visit_row(i, [&](std::size_t neighbour, std::size_t bond_class) {
          EXPECT_EQ(neighbour, static_cast<std::size_t>(list.neighbour[e])) << i;
          EXPECT_EQ(bond_class, list.bond_class[e++]) << i;
        });
      }
      EXPECT_EQ(computed, listed);
      const Neighbours copy = computed;
      EXPECT_EQ(&copy.list(), &computed.list());
    }
  }
  EXPECT_FALSE(Neighbours::of_rings(3, 120) == Neighbours::of_rings(3, 121));
  EXPECT_FALSE(Neighbours::of_rings(3, 120) == Neighbours(ring_bonds(3, 121)));
  EXPECT_EQ(Neighbours().particles(), 0U);
}

// Of balls that keep their bonds and of one that does not.
TEST(Neighbours, EachBondIsVisitedOnceRowByRow) {
  using Bonds = std::vector<std::array<std::size_t, 3>>;
  for (const std::int64_t per_ring : {4, 120, 7000}) {
    for (const Neighbours& neighbours :
         {Neighbours::of_rings(3, per_ring), Neighbours(ring_bonds(3, per_ring))}) {
      Bonds expected, found;
      for (std::size_t i = 0; i < neighbours.particles(); ++i) {
        neighbours.visit_row(i, [&](std::size_t j, std::size_t bond_class) {
          if (j > i) expected.push_back({i, j, bond_class});
        });
      }
      neighbours.for_each_bond([&](std::size_t i, std::size_t j, std::size_t bond_class) {
        found.push_back({i, j, bond_class});
      });
      EXPECT_EQ(found.size(), neighbours.bonds());
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(Neighbours, AnyThreadMayAskForTheList) {
  const Neighbours neighbours = Neighbours::of_rings(3, 5000);
  std::vector<const BondList*> seen(4);
#pragma omp parallel for num_threads(4)
  for (std::size_t t = 0; t < 4; ++t) seen[t] = &neighbours.list();
  for (const BondList* list : seen) {
    EXPECT_EQ(list, seen.front());
    EXPECT_EQ(list->particles(), 15000U);
  }
}

}  // namespace
}  // namespace bounce
