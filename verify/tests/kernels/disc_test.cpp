// The disc: its particles, its bonds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kernels/model/ball.hpp"
#include "kernels/model/bonds.hpp"
#include "kernels/model/problem.hpp"
#include "verify/tests/kernels/kernel_scenes.hpp"

namespace bounce {
namespace {

// Lattice points within 1, sqrt(3), 2, sqrt(7), 3 spacings of one of them, counted by hand; bonds
// of a full hexagon of side n: 9 n^2 + 3 n.
TEST(Disc, HoldsTheLatticePointsWithinItsRadius) {
  struct Count {
    double radius;
    std::size_t particles;
  };
  for (const Count& c : {Count{1.0, 7},
                         {1.7, 7},
                         {std::sqrt(3.0), 13},
                         {2.0, 19},
                         {2.6, 19},
                         {std::sqrt(7.0), 31},
                         {3.0, 37}}) {
    const double spacing = 0.3;
    const Problem p = make_problem(disc_scene(c.radius * spacing, spacing));
    EXPECT_EQ(p.initial.size(), c.particles) << c.radius;
    EXPECT_EQ(ball_size(disc_scene(c.radius, 1.0).ball).particles, c.particles) << c.radius;
  }
  EXPECT_EQ(make_problem(disc_scene(1.0, 1.0)).bonds.bonds(), 12U);
  EXPECT_EQ(make_problem(disc_scene(2.0, 1.0)).bonds.bonds(), 42U);
}

// By brute force: bound are those a spacing apart, and no others stand nearer than sqrt(3) of it.
TEST(Disc, BindsWhoStandsASpacingApart) {
  const Scene scene = disc_scene(2.3, 0.31);
  const Problem p = make_problem(scene);
  const State& s = p.initial;
  EXPECT_NO_THROW(check_bonds(p.bonds));
  std::size_t bonds = 0;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_LE(std::hypot(s.x[i], s.y[i] - 10.0), 2.3 * (1.0 + 1e-12));
    if (p.bonds.row_length(i) == 6) ++inside;
    EXPECT_GE(p.bonds.row_length(i), 2U);
    std::vector<std::size_t> near;
    for (std::size_t j = 0; j < s.size(); ++j) {
      const double d = std::hypot(s.x[i] - s.x[j], s.y[i] - s.y[j]) / 0.31;
      if (j != i && d < 1.5) {
        EXPECT_NEAR(d, 1.0, 1e-13);
        near.push_back(j);
      }
    }
    std::vector<std::size_t> row;
    p.bonds.visit_row(i, [&row](std::size_t j, std::size_t c) {
      EXPECT_EQ(c, 0U);
      row.push_back(j);
    });
    std::sort(row.begin(), row.end());
    EXPECT_EQ(row, near) << i;
    bonds += near.size();
  }
  EXPECT_EQ(p.bonds.entries(), bonds);
  EXPECT_GT(inside, s.size() / 2);
  EXPECT_EQ(ball_size(scene.ball).entries, bonds);
  EXPECT_EQ(ball_size(scene.ball).list_bytes, 8 * (s.size() + 1) + 6 * bonds);
  ASSERT_EQ(p.classes.size(), 1U);
  EXPECT_NEAR(p.classes[0].rest, 0.31, 1e-15);
}

TEST(Disc, IsSymmetricAndRoundedOnDemand) {
  Scene scene = disc_scene(2.0, 0.25);
  const State exact = make_ball(scene.ball);
  double sum_x = 0.0, sum_y = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    sum_x += exact.x[i];
    sum_y += exact.y[i] - 10.0;
  }
  EXPECT_NEAR(sum_x, 0.0, 1e-12);
  EXPECT_NEAR(sum_y, 0.0, 1e-11);
  scene.ball.rounding = Rounding::listing;
  const State rounded = make_ball(scene.ball);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_EQ(rounded.x[i], four_decimals(exact.x[i]));
    EXPECT_EQ(rounded.y[i], four_decimals(exact.y[i]));
  }
}

}  // namespace
}  // namespace bounce
