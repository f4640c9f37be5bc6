#include "verify/watch/observables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

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

Sample sample_at(double height, std::int64_t on_wall, double energy) {
  Sample sample;
  sample.centre.y = height;
  sample.on_wall = on_wall;
  sample.kinetic = energy;
  return sample;
}

TEST(BounceGauge, GathersABounce) {
  BounceGauge gauge;
  gauge.add(0.0, sample_at(10.0, 0, 100.0));
  EXPECT_EQ(gauge.result().first_contact, -1.0);
  EXPECT_EQ(gauge.result().rebound_height, 10.0);
  gauge.add(1.0, sample_at(7.0, 3, 90.0));
  gauge.add(2.0, sample_at(5.0, 9, 80.0));
  gauge.add(3.0, sample_at(7.0, 1, 70.0));
  gauge.add(4.0, sample_at(9.0, 0, 65.0));
  gauge.add(5.0, sample_at(8.0, 0, 65.0));
  const Bounce& bounce = gauge.result();
  EXPECT_EQ(bounce.lowest_centre, 5.0);
  EXPECT_EQ(bounce.lowest_centre_time, 2.0);
  EXPECT_EQ(bounce.first_contact, 1.0);
  EXPECT_EQ(bounce.last_contact, 3.0);
  EXPECT_EQ(bounce.contact_time, 3.0);  // 0.5 to 3.5
  EXPECT_EQ(bounce.rebound_height, 9.0);
  EXPECT_EQ(bounce.energy_lost, 35.0);
}

TEST(BounceGauge, ADeeperSecondBounceCounts) {
  BounceGauge gauge;
  gauge.add(0.0, sample_at(10.0, 0, 1.0));
  gauge.add(1.0, sample_at(6.0, 1, 1.0));
  gauge.add(2.0, sample_at(9.0, 0, 1.0));
  gauge.add(3.0, sample_at(5.5, 1, 1.0));
  gauge.add(4.0, sample_at(7.5, 0, 1.0));
  EXPECT_EQ(gauge.result().lowest_centre_time, 3.0);
  EXPECT_EQ(gauge.result().rebound_height, 7.5);
  EXPECT_EQ(gauge.result().first_contact, 1.0);
  EXPECT_EQ(gauge.result().contact_time, 1.0 + 1.0);
}

TEST(BounceGauge, RefusesDisorder) {
  BounceGauge gauge;
  gauge.add(1.0, sample_at(10.0, 0, 1.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(gauge.add(1.0, sample_at(10.0, 0, 1.0)), std::invalid_argument);
  EXPECT_THROW(gauge.add(0.5, sample_at(10.0, 0, 1.0)), std::invalid_argument);
  EXPECT_THROW(gauge.add(nan, sample_at(10.0, 0, 1.0)), std::invalid_argument);
  EXPECT_THROW(gauge.add(2.0, sample_at(nan, 0, 1.0)), std::invalid_argument);
  EXPECT_THROW(gauge.add(2.0, sample_at(10.0, 0, nan)), std::invalid_argument);
}

// A centre of mass at that height with that vertical momentum.
Sample moving_at(double height, double momentum) {
  Sample sample = sample_at(height, 0, 1.0);
  sample.momentum = {0.0, momentum};
  return sample;
}

// A ball in chatter: the wall pushes, lets go and pushes again before the ball leaves.
TEST(BounceGauge, ContactAndRestitutionFromTheImpulse) {
  BounceGauge gauge;
  gauge.add(0.0, moving_at(10.0, 0.0), {});
  gauge.add(1.0, moving_at(8.0, -10.0), {});
  EXPECT_FALSE(gauge.result().restitution);
  EXPECT_EQ(gauge.result().first_contact, -1.0);
  gauge.add(2.0, moving_at(7.0, 2.0), {true, {0.0, 13.0}});
  EXPECT_FALSE(gauge.result().restitution);  // not left
  gauge.add(3.0, moving_at(7.5, 1.0), {});
  EXPECT_DOUBLE_EQ(*gauge.result().restitution, 0.2);
  gauge.add(4.0, moving_at(7.6, 6.0), {true, {0.0, 6.0}});
  EXPECT_FALSE(gauge.result().restitution);
  gauge.add(5.0, moving_at(8.0, 5.0), {});
  EXPECT_DOUBLE_EQ(*gauge.result().restitution, 0.6);
  EXPECT_EQ(gauge.result().first_contact, 1.0);
  EXPECT_EQ(gauge.result().last_contact, 4.0);
  EXPECT_EQ(gauge.result().contact_time, 2.0);
  // The second bounce does not count.
  gauge.add(6.0, moving_at(8.0, -5.0), {});
  gauge.add(7.0, moving_at(7.0, 1.0), {true, {0.0, 7.0}});
  gauge.add(8.0, moving_at(7.1, 0.5), {});
  EXPECT_DOUBLE_EQ(*gauge.result().restitution, 0.6);
  EXPECT_EQ(gauge.result().contact_time, 3.0);
}

// Speed along a wall does not count, nor what friction takes of it.
TEST(BounceGauge, RestitutionIsAlongTheWallsNormal) {
  Wall incline;
  incline.normal = {std::sqrt(0.5), std::sqrt(0.5)};
  BounceGauge gauge(std::vector<Wall>{Wall{}, incline});
  const auto at = [&](double normal, double tangential) {
    Sample sample = sample_at(8.0, 0, 1.0);
    sample.momentum = {std::sqrt(0.5) * (normal - tangential),
                       std::sqrt(0.5) * (normal + tangential)};
    return sample;
  };
  gauge.add(0.0, at(-4.0, -7.0), {});
  // Normal speed -4 to 2, tangential -7 to -5.
  gauge.add(1.0, at(2.0, -5.0),
            {true, {std::sqrt(0.5) * (6.0 - 2.0), std::sqrt(0.5) * (6.0 + 2.0)}});
  gauge.add(2.0, at(2.0, -5.0), {});
  // The axis met less of the impulse: 5.66 of it are along y, 6 along the incline's normal.
  EXPECT_NEAR(*gauge.result().restitution, 0.5, 1e-15);
}

TEST(BounceGauge, NoRestitutionWithoutAnImpact) {
  BounceGauge resting;
  resting.add(0.0, moving_at(7.0, 0.0), {});
  for (int i = 1; i < 50; ++i) resting.add(i, moving_at(7.0, 0.0), {true, {0.0, 35.0}});
  resting.add(50.0, moving_at(7.0, 1.0), {});
  EXPECT_FALSE(resting.result().restitution);
  BounceGauge dead;
  dead.add(0.0, moving_at(7.0, -5.0), {});
  dead.add(1.0, moving_at(7.0, 0.0), {true, {0.0, 40.0}});
  dead.add(2.0, moving_at(7.0, 0.0), {true, {0.0, 35.0}});
  EXPECT_FALSE(dead.result().restitution);
}

TEST(BounceGauge, KeepsTheGreatestFlattening) {
  BounceGauge gauge;
  for (const double flattening : {0.1, 0.3, 0.2}) {
    Shape shape;
    shape.flattening = flattening;
    gauge.add_shape(10.0 * flattening, shape);
  }
  EXPECT_EQ(gauge.result().greatest_flattening, 0.3);
  EXPECT_EQ(gauge.result().greatest_flattening_time, 3.0);
}

}  // namespace
}  // namespace bounce
