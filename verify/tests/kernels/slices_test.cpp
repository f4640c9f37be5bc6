// The sliced list of the kernel csr against the list of bonds it is made of.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "kernels/csr/slices.hpp"
#include "kernels/model/bonds.hpp"

namespace bounce {
namespace {

TEST(Slices, HoldEveryEntryOfTheListOnce) {
  for (const auto& [rings, per_ring] : {std::pair{3, 120}, {5, 121}, {1, 7}}) {
    const BondList bonds = ring_bonds(rings, per_ring);
    for (const int lanes : {1, 4, 8}) {
      const SlicedBonds sliced = slice_bonds(bonds, lanes);
      std::size_t entries = 0;
      for (std::size_t s = 0; s < sliced.slices.size(); ++s) {
        for (std::int32_t k = 0; k < sliced.slices[s].all; ++k) {
          const SliceEntry entry =
              sliced.entries[static_cast<std::size_t>(sliced.slices[s].begin + k)];
          for (std::size_t l = 0; l < static_cast<std::size_t>(lanes); ++l) {
            const auto width = static_cast<std::size_t>(lanes);
            const int bond_class =
                sliced.combinations[static_cast<std::size_t>(entry.combination) * width + l];
            if (bond_class == no_bond) continue;
            const std::size_t i = s * width + l;
            const auto e = static_cast<std::size_t>(bonds.start[i] + k);
            const std::int64_t neighbour =
                entry.first >= 0
                    ? entry.first + static_cast<std::int64_t>(l)
                    : sliced.scattered[static_cast<std::size_t>(-1 - entry.first) * width + l];
            EXPECT_EQ(neighbour, bonds.neighbour[e]);
            EXPECT_EQ(bond_class, bonds.bond_class[e]);
            ++entries;
          }
        }
      }
      EXPECT_EQ(entries, bonds.entries());
    }
  }
}

}  // namespace
}  // namespace bounce
