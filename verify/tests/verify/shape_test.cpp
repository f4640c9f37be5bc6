#include "verify/figures/shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/model/problem.hpp"
#include "verify/tests/paper_scenes.hpp"

namespace bounce {
namespace {

// Rings on an ellipse of axes a and b times their radius, turned by `angle`, spinning and moving.
State ellipses(double a, double b, double angle, double spin) {
  State state;
  for (const double radius : {5.0, 6.0, 7.0}) {
    for (int i = 0; i < 120; ++i) {
      const double t = 2.0 * std::numbers::pi * i / 120.0;
      const double u = a * radius * std::cos(t);
      const double v = b * radius * std::sin(t);
      const double x = u * std::cos(angle) - v * std::sin(angle);
      const double y = u * std::sin(angle) + v * std::cos(angle);
      state.x.push_back(x + 100.0);
      state.y.push_back(y + 50.0);
      state.vx.push_back(-spin * y + 4.0);
      state.vy.push_back(spin * x - 2.0);
    }
  }
  return state;
}

TEST(Shape, RoundBall) {
  const Shape shape = measure_shape(make_problem(paper_scene(2)).initial, 3);
  EXPECT_NEAR(shape.width, 14.0, 1e-12);
  EXPECT_NEAR(shape.height, 14.0, 1e-12);
  EXPECT_NEAR(shape.flattening, 0.0, 1e-5);  // four decimals of 7 cm
  // A polygon of 120 sides in a circle of 5 cm; four decimals.
  EXPECT_NEAR(shape.enclosed, 0.5 * 120 * 25.0 * std::sin(std::numbers::pi / 60.0), 1e-3);
  EXPECT_EQ(shape.spin, 0.0);
}

TEST(Shape, WithoutRingsTheWholeBallIsTheOutline) {
  const Shape rings = measure_shape(ellipses(1.0, 0.5, 0.7, -0.3), 3);
  const Shape none = measure_shape(ellipses(1.0, 0.5, 0.7, -0.3));
  EXPECT_NEAR(none.flattening, 0.5, 1e-13);
  EXPECT_EQ(none.width, rings.width);
  EXPECT_EQ(none.spin, rings.spin);
  EXPECT_TRUE(std::isnan(none.enclosed));
}

TEST(Shape, TurnedEllipse) {
  const Shape shape = measure_shape(ellipses(1.0, 0.5, 0.7, -0.3), 3);
  EXPECT_NEAR(shape.flattening, 0.5, 1e-13);
  EXPECT_NEAR(shape.enclosed, 0.25 * 120 * 25.0 * std::sin(std::numbers::pi / 60.0), 1e-11);
  EXPECT_NEAR(shape.spin, -0.3, 1e-13);
  const Shape upright = measure_shape(ellipses(0.5, 1.0, 0.0, 0.0), 3);
  EXPECT_NEAR(upright.width, 7.0, 1e-12);
  EXPECT_NEAR(upright.height, 14.0, 1e-12);
}

TEST(Shape, InsideOutEnclosesLessThanNothing) {
  EXPECT_LT(measure_shape(ellipses(1.0, -1.0, 0.0, 0.0), 3).enclosed, -70.0);
}

TEST(Shape, StraightLineIsFlat) {
  const Shape shape = measure_shape(ellipses(1.0, 0.0, 0.3, 0.0), 3);
  EXPECT_NEAR(shape.flattening, 1.0, 1e-6);  // square root of rounding
  EXPECT_NEAR(shape.enclosed, 0.0, 1e-12);
}

// Wherever the number stands: reductions over vectors treat the first ones on their own.
TEST(Shape, NaNStaysVisible) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t i : {0U, 1U, 5U, 122U, 300U, 359U}) {
    State state = ellipses(1.0, 1.0, 0.0, 0.0);
    state.x[i] = nan;
    state.y[i] = nan;
    const Shape shape = measure_shape(state, 3);
    EXPECT_TRUE(std::isnan(shape.width)) << i;
    EXPECT_TRUE(std::isnan(shape.height)) << i;
    EXPECT_TRUE(std::isnan(shape.spin)) << i;
    EXPECT_EQ(std::isnan(shape.flattening), i >= 240) << i;  // of the outer ring
    EXPECT_EQ(std::isnan(shape.enclosed), i < 120) << i;     // of the inner ring
  }
}

TEST(Shape, RefusesWhatIsNoBall) {
  EXPECT_THROW(measure_shape(State(361), 3), std::invalid_argument);
  EXPECT_THROW(measure_shape(State(0), 3), std::invalid_argument);
  EXPECT_THROW(measure_shape(State(360), 0), std::invalid_argument);
}

}  // namespace
}  // namespace bounce
