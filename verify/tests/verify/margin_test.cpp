// The margin of a run against Lanczos at each of its states.
#include "verify/watch/margin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "kernels/model/method.hpp"
#include "verify/oracle/oracle.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

State shaken(const Problem& problem, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-by, by);
  State state = problem.initial;
  for (double& x : state.x) x += move(random);
  for (double& y : state.y) y += move(random);
  return state;
}

double exact_part(const Problem& problem, const State& state) {
  return part_of_stable_step(problem, fastest_vibration(problem, state).value().omega);
}

TEST(Margin, PartIsStepOverStableStep) {
  const Problem problem = make_problem(paper_scene(2));
  const double omega = fastest_vibration(problem, problem.initial).value().omega;
  EXPECT_DOUBLE_EQ(part_of_stable_step(problem, omega), problem.step * omega / 2.0);
}

// The z at which a vibration of x and v/w first grows, by steps of the method from two starts: not
// by what the program finds its limits with. Windows are 6e-3 wide at least.
double limit_of(const Method& method) {
  constexpr double grid = 5e-4;
  for (double z = grid;; z += grid) {
    double x[2] = {1.0, 0.0}, v[2] = {0.0, 1.0};
    for (const Stage& stage : method.stages) {
      for (int start = 0; start < 2; ++start) {
        v[start] -= stage.kick * z * x[start];
        x[start] += stage.drift * z * v[start];
      }
    }
    if (std::abs(x[0] + v[1]) > 2.0 + 1e-9) return z;
  }
}

// They differ from method to method: 2 for two of them alone.
TEST(Margin, PartIsByEachMethodsOwnLimit) {
  for (const Method& method : methods()) {
    Scene scene = paper_scene(2);
    scene.time.method = method.name;
    scene.time.step = 1e-4;
    const Problem problem = make_problem(scene);
    const double omega = fastest_vibration(problem, problem.initial).value().omega;
    const double part = problem.step * omega / limit_of(method);
    EXPECT_NEAR(part_of_stable_step(problem, omega) / part, 1.0, 1e-3) << method.name;
    MarginGauge gauge(problem);
    // The bound lies 0.3 % above Lanczos here.
    EXPECT_NEAR(gauge.add(7, problem.initial) / part, 1.002, 4e-3) << method.name;
    const auto margin = gauge.result();
    ASSERT_TRUE(margin && margin->exact) << method.name;
    EXPECT_NEAR(margin->part / part, 1.0, 1e-3) << method.name;
    EXPECT_NEAR(margin->at_most / part, 1.0, 1e-3) << method.name;
    EXPECT_EQ(margin->step, 7) << method.name;
  }
}

// No shaking is like another, and the worst by the bound need not be the worst: all the same the
// worst is found, or the margin says how much worse it could be.
TEST(Margin, IsTheWorstOfAllStates) {
  const Problem problem = make_problem(paper_scene(2));
  int certain = 0;
  for (unsigned run = 0; run < 10; ++run) {
    MarginGauge gauge(problem);
    double worst = 0.0;
    std::int64_t worst_step = -1;
    for (unsigned n = 0; n < 30; ++n) {
      const State state = shaken(problem, 0.02 + 0.002 * ((7 * n) % 30), 100 * run + n);
      const double exact = exact_part(problem, state);
      EXPECT_GE(gauge.add(n, state), exact);
      if (exact > worst) worst_step = n;
      worst = std::max(worst, exact);
    }
    const auto margin = gauge.result();
    ASSERT_TRUE(margin);
    EXPECT_TRUE(margin->exact);
    EXPECT_GE(margin->at_most, worst);
    EXPECT_LE(margin->part, worst);
    if (margin->at_most == margin->part) {
      EXPECT_EQ(margin->part, worst);
      EXPECT_EQ(margin->step, worst_step);
      ++certain;
    }
  }
  EXPECT_GE(certain, 8);  // the eight kept are as a rule enough
}

// Sixty slight shakings of one strength, whose bounds lie closer together than bound and Lanczos,
// are too many to keep: those dropped count by their bound.
TEST(Margin, WhatIsNotKeptIsBounded) {
  const Problem problem = make_problem(paper_scene(2));
  int uncertain = 0;
  for (unsigned run = 0; run < 5; ++run) {
    MarginGauge gauge(problem);
    std::vector<double> bounds;
    double worst = 0.0;
    for (unsigned n = 0; n < 60; ++n) {
      const State state = shaken(problem, 0.001, 1000 + 100 * run + n);
      bounds.push_back(gauge.add(n, state));
      worst = std::max(worst, exact_part(problem, state));
    }
    std::sort(bounds.rbegin(), bounds.rend());
    const auto margin = gauge.result();
    ASSERT_TRUE(margin);
    EXPECT_GE(margin->at_most, worst);
    EXPECT_GE(margin->at_most, bounds[8]);  // eight are kept
    if (margin->at_most > margin->part) ++uncertain;
  }
  EXPECT_GE(uncertain, 1) << "nothing was put to the test";
}

// The bound of the first state is the larger, its exact part the smaller.
TEST(Margin, LooksBeyondTheBound) {
  const Problem problem = make_problem(paper_scene(2));
  std::vector<State> states;
  for (unsigned n = 0; n < 60; ++n) states.push_back(shaken(problem, 0.02, n));
  for (const State& a : states) {
    for (const State& b : states) {
      if (!(stiffness_bound(problem, a)->lambda > stiffness_bound(problem, b)->lambda)) continue;
      if (!(exact_part(problem, a) < exact_part(problem, b))) continue;
      MarginGauge gauge(problem);
      gauge.add(1, a);
      gauge.add(2, b);
      const auto margin = gauge.result();
      ASSERT_TRUE(margin);
      EXPECT_EQ(margin->step, 2);
      EXPECT_EQ(margin->part, exact_part(problem, b));
      return;
    }
  }
  FAIL() << "no two such states among those tried";
}

TEST(Margin, SaysWhenAndWhere) {
  const Problem problem = make_problem(paper_scene(2));
  MarginGauge gauge(problem);
  gauge.add(0, problem.initial);
  State pressed = problem.initial;
  pressed.x[250] = pressed.x[251] + 0.1;  // ring 3, R/R0 = 0.27
  pressed.y[250] = pressed.y[251];
  gauge.add(1000, pressed);
  for (std::int64_t n = 2; n < 100; ++n) gauge.add(1000 * n, problem.initial);
  const auto margin = gauge.result();
  ASSERT_TRUE(margin);
  EXPECT_EQ(margin->step, 1000);
  EXPECT_EQ(margin->first, 250);
  EXPECT_EQ(margin->second, 251);
  EXPECT_NEAR(margin->ratio, 0.1 / std::sqrt(0.1343), 1e-12);
  EXPECT_EQ(margin->part, exact_part(problem, pressed));
  EXPECT_EQ(margin->at_most, margin->part);
}

TEST(Margin, StatesThatAreNotFinite) {
  const Problem problem = make_problem(paper_scene(2));
  State bad = problem.initial;
  bad.y[3] = std::numeric_limits<double>::quiet_NaN();
  MarginGauge gauge(problem);
  EXPECT_FALSE(gauge.result());
  EXPECT_TRUE(std::isnan(gauge.add(0, bad)));
  EXPECT_FALSE(gauge.result());
  gauge.add(1, problem.initial);
  const auto margin = gauge.result();
  ASSERT_TRUE(margin);
  EXPECT_EQ(margin->step, 1);
  EXPECT_EQ(margin->at_most, std::numeric_limits<double>::infinity());
}

TEST(Margin, AVeryLargeBallKeepsNoState) {
  Scene scene;
  scene.ball = {.radii = {5, 6, 7}, .per_ring = 20'000, .centre = {0, 10}};
  scene.law.rest = Rest::geometry;
  const Problem problem = make_problem(scene);
  MarginGauge gauge(problem);
  const double part = gauge.add(5, problem.initial);
  const auto margin = gauge.result();
  ASSERT_TRUE(margin);
  EXPECT_FALSE(margin->exact);
  EXPECT_EQ(margin->part, part);
  EXPECT_EQ(margin->step, 5);
}

}  // namespace
}  // namespace bounce
