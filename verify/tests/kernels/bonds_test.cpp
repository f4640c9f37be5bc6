// The list of bonds: that of the listing, and what its check catches.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "kernels/model/bonds.hpp"
#include "kernels/model/problem.hpp"
#include "verify/tests/paper_scenes.hpp"

namespace bounce {
namespace {

// Neighbours of particle i (from 1) in the order in which the listing sums them.
std::vector<int> listing_row(int i) {
  if (i == 1) return {2, 120, 121, 240};
  if (i <= 119) return {i + 1, i - 1, i + 120, i + 119};
  if (i == 120) return {1, 119, 240, 239};
  if (i == 121) return {1, 2, 122, 240, 242, 241};
  if (i <= 239) return {i - 120, i - 119, i + 1, i - 1, i + 120, i + 121};
  if (i == 240) return {120, 1, 121, 239, 360, 241};
  if (i == 241) return {242, 360, 121, 240};
  if (i <= 359) return {i + 1, i - 1, i - 120, i - 121};
  return {359, 241, 240, 239};
}

int ring_of(int i) { return (i - 1) / 120; }

std::vector<int> row_of(const BondList& bonds, int i) {
  const auto row = static_cast<std::size_t>(i - 1);
  std::vector<int> found;
  for (auto e = bonds.start[row]; e < bonds.start[row + 1]; ++e) {
    found.push_back(bonds.neighbour[static_cast<std::size_t>(e)] + 1);
  }
  return found;
}

TEST(Bonds, PapersBallInTheListingsOrder) {
  const BondList bonds = ring_bonds(3, 120);
  ASSERT_EQ(bonds.particles(), 360U);
  EXPECT_EQ(bonds.bonds(), 840U);
  EXPECT_EQ(bonds.entries(), 1680U);
  for (int i = 1; i <= 360; ++i) EXPECT_EQ(row_of(bonds, i), listing_row(i)) << "particle " << i;
}

TEST(Bonds, ClassIsTheSumOfTheRings) {
  const BondList bonds = ring_bonds(3, 120);
  for (int i = 1; i <= 360; ++i) {
    auto e = static_cast<std::size_t>(bonds.start[static_cast<std::size_t>(i - 1)]);
    for (const int j : listing_row(i)) {
      EXPECT_EQ(static_cast<int>(bonds.bond_class[e++]), ring_of(i) + ring_of(j)) << i << "-" << j;
    }
  }
}

TEST(Bonds, SymmetricForAnyRings) {
  for (const int rings : {1, 2, 3, 4, 7}) {
    for (const std::int64_t per_ring : {3, 4, 5, 120}) {
      const BondList bonds = ring_bonds(rings, per_ring);
      EXPECT_NO_THROW(check_bonds(bonds)) << rings << " x " << per_ring;
      const auto n = static_cast<std::size_t>(per_ring);
      const auto r = static_cast<std::size_t>(rings);
      EXPECT_EQ(bonds.bonds(), r * n + 2 * (r - 1) * n);
    }
  }
}

// Bonds of the list are the shortest distances there are: nothing else lies as near.
TEST(Bonds, JoinNearestParticles) {
  const Problem problem = make_problem(paper_scene(2));
  for (const BondClass& bond_class : problem.classes) EXPECT_GT(bond_class.rest, 0.26);
  for (int i = 1; i <= 360; ++i) {
    const auto a = static_cast<std::size_t>(i - 1);
    for (const int j : listing_row(i)) {
      const auto b = static_cast<std::size_t>(j - 1);
      const double d = std::hypot(problem.initial.x[a] - problem.initial.x[b],
                                  problem.initial.y[a] - problem.initial.y[b]);
      const auto c = static_cast<std::size_t>(ring_of(i)) + static_cast<std::size_t>(ring_of(j));
      EXPECT_NEAR(d, problem.classes[c].rest, 2e-4) << i << "-" << j;  // four decimals at both ends
    }
  }
}

TEST(Bonds, CheckCatchesEachCorruption) {
  const BondList good = ring_bonds(3, 120);
  EXPECT_NO_THROW(check_bonds(good));
  const std::vector<std::function<void(BondList&)>> corruptions{
      [](BondList& b) { b.neighbour[17] = 360; },                // out of range
      [](BondList& b) { b.neighbour[17] = -1; },                 //
      [](BondList& b) { b.neighbour[20] = 5; },                  // itself
      [](BondList& b) { b.neighbour[1] = b.neighbour[0]; },      // twice
      [](BondList& b) { b.neighbour[2] = 200; },                 // no way back
      [](BondList& b) { b.bond_class[9] = 4; },                  // another class there
      [](BondList& b) { b.start[10] += 1; },                     // a row too long
      [](BondList& b) { std::swap(b.start[10], b.start[11]); },  // not increasing
      [](BondList& b) { b.start.back() -= 1; },                  // entries left over
      [](BondList& b) { b.start.front() = 1; },                  //
      [](BondList& b) { b.start.clear(); },                      //
      [](BondList& b) { b.bond_class.pop_back(); },              //
  };
  for (std::size_t k = 0; k < corruptions.size(); ++k) {
    BondList bad = good;
    corruptions[k](bad);
    EXPECT_THROW(check_bonds(bad), std::logic_error) << "corruption " << k;
  }
}

}  // namespace
}  // namespace bounce
