// What a scene becomes as a problem: constants, bond classes, the start.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

#include "kernels/model/ball.hpp"
#include "kernels/model/bonds.hpp"
#include "kernels/model/problem.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

TEST(Problem, SingleLiterals) {
  EXPECT_EQ(single_literal(1096.64), 1096.6400146484375);  // as FORTRAN reads it
  EXPECT_EQ(single_literal(0.098), 0.09799999743700027);
  EXPECT_EQ(single_literal(0.000001), 9.999999974752427e-07);
  EXPECT_EQ(single_literal(16000.0), 16000.0);
}

// Both components at once: GCC 12.2 drops the rounding of a pair unless it is kept from it.
TEST(Problem, GravityAndStepAreRounded) {
  Scene scene = paper_scene(2);
  scene.gravity = {0.1, -0.098};
  const Problem rounded = make_problem(scene);
  EXPECT_EQ(rounded.gravity.x, static_cast<double>(0.1F));
  EXPECT_EQ(rounded.gravity.y, -0.09799999743700027);
  EXPECT_EQ(rounded.step, 9.999999974752427e-07);
  scene.constants = Constants::double_precision;
  EXPECT_EQ(make_problem(scene).gravity.y, -0.098);
  EXPECT_EQ(make_problem(scene).step, 1e-6);
}

TEST(Problem, ClassesOfThePapersBall) {
  const Problem problem = make_problem(paper_scene(2));
  const std::array<float, 5> repulsion{1096.64F, 16328.0F, 1578.4F, 16462.8F, 2148.8F};
  const std::array<double, 5> rest_squared{0.06854, 1.0205, 0.09865, 1.028925, 0.1343};
  ASSERT_EQ(problem.classes.size(), 5U);
  for (std::size_t c = 0; c < 5; ++c) {
    EXPECT_EQ(problem.classes[c].attraction, 16000.0);
    EXPECT_EQ(problem.classes[c].repulsion, static_cast<double>(repulsion[c]));
    EXPECT_NEAR(problem.classes[c].rest, std::sqrt(rest_squared[c]), 1e-15);
  }
}

TEST(Problem, RestFromGeometry) {
  Scene scene = paper_scene(2);
  scene.law.rest = Rest::geometry;
  scene.constants = Constants::double_precision;
  const Problem problem = make_problem(scene);
  const double s = std::sin(std::numbers::pi / 120.0);
  const double c = std::cos(std::numbers::pi / 120.0);
  const std::array<double, 5> rest_squared{100 * s * s, 61 - 60 * c, 144 * s * s, 85 - 84 * c,
                                           196 * s * s};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(problem.classes[k].rest, std::sqrt(rest_squared[k]), 1e-13);
    EXPECT_NEAR(problem.classes[k].repulsion, 16000.0 * rest_squared[k], 1e-9);
  }
}

TEST(Problem, GeometryIsTheDistanceOfTheExactBall) {
  Scene scene = paper_scene(2);
  scene.law.rest = Rest::geometry;
  scene.ball.rounding = Rounding::none;
  scene.ball.radii = {10.0, 11.0, 12.0, 14.5};
  scene.ball.per_ring = 50;
  scene.ball.centre.y = 20.0;
  const Problem p = make_problem(scene);
  const BondList& bonds = p.bonds;
  for (std::size_t i = 0; i < bonds.particles(); ++i) {
    for (auto e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto j = static_cast<std::size_t>(bonds.neighbour[static_cast<std::size_t>(e)]);
      const double d = std::hypot(p.initial.x[i] - p.initial.x[j], p.initial.y[i] - p.initial.y[j]);
      EXPECT_NEAR(d, p.classes[bonds.bond_class[static_cast<std::size_t>(e)]].rest, 1e-13);
    }
  }
}

TEST(Problem, StartHasFourDecimals) {
  const State start = make_problem(paper_scene(5)).initial;
  ASSERT_EQ(start.size(), 360U);
  for (std::size_t i = 0; i < 360; ++i) {
    for (const double v : {start.x[i], start.y[i], start.vx[i], start.vy[i]}) {
      // The double nearest to a number of four decimals.
      EXPECT_TRUE(same_bits(v, std::round(v * 1e4) / 1e4)) << "particle " << i + 1;
    }
    EXPECT_EQ(start.vx[i], 4.0);
  }
  EXPECT_EQ(start.x[0], 5.0);
  EXPECT_EQ(start.y[0], 10.0);
  EXPECT_EQ(start.x[1], 4.9931);  // 5 cos 3 deg = 4.993148
  EXPECT_EQ(start.y[1], 10.2617);
  EXPECT_EQ(start.x[120], 5.9979);  // 6 cos 1.5 deg = 5.997944
}

TEST(Problem, StartIsMirrorSymmetric) {
  const State s = make_problem(paper_scene(2)).initial;
  for (int ring = 0; ring < 3; ++ring) {
    for (int column = 0; column < 120; ++column) {
      const int mirrored = ring == 1 ? (59 - column + 120) % 120 : (60 - column + 120) % 120;
      const auto i = std::size_t{120} * ring + column;
      const auto j = std::size_t{120} * ring + mirrored;
      EXPECT_TRUE(same_bits(s.x[i], 0.0 - s.x[j])) << "particles " << i + 1 << ", " << j + 1;
      EXPECT_TRUE(same_bits(s.y[i], s.y[j])) << "particles " << i + 1 << ", " << j + 1;
    }
  }
}

TEST(Problem, TakesAnotherStart) {
  const Scene scene = paper_scene(2);
  State start = make_problem(scene).initial;
  start.vx[3] = 1.5;
  EXPECT_EQ(make_problem(scene, start).initial.vx[3], 1.5);
  EXPECT_THROW(make_problem(scene, State(359)), SceneError);
  start.y[100] = -1.0;
  EXPECT_THROW(make_problem(scene, start), SceneError);
  start.y[100] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make_problem(scene, start), SceneError);
}

TEST(Problem, RefusesABallBehindAWall) {
  Scene scene = paper_scene(2);
  scene.ball.centre.y = 6.9;
  try {
    make_problem(scene);
    FAIL() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.key, "wall[0]");
    EXPECT_NE(std::string(error.what()).find("behind"), std::string::npos) << error.what();
  }
  scene.ball.centre.y = 7.0;  // touches
  EXPECT_NO_THROW(make_problem(scene));
}

}  // namespace
}  // namespace bounce
