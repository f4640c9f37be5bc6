// What each method's table declares, measured: generated for every method of the registry.
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/method.hpp"
#include "kernels/stepping/plan.hpp"

namespace bounce {
namespace {

class MethodTest : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] const Method& method() const { return *find_method(GetParam()); }
};

// A free ball: smooth motion on the scale of the largest steps below.
Scene rippling_scene(const std::string& method, double step) {
  Scene scene;
  scene.constants = Constants::double_precision;
  scene.ball.rounding = Rounding::none;
  scene.law.rest = Rest::geometry;
  scene.law.elasticity = 1000.0;
  scene.gravity = {};
  scene.time.method = method;
  scene.time.step = step;
  scene.output.monitor_every = 1.0;
  return scene;
}

// Turning, rippling, and strained: from rest the first-order error of the listing's scheme, half a
// step's kick at the start, would vanish.
State rippling_start() {
  State state = make_problem(rippling_scene("listing", 1e-4)).initial;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double x = state.x[i], y = state.y[i] - 10.0;
    state.vx[i] = -0.5 * y + 0.4 * std::sin(x);
    state.vy[i] = 0.5 * x + 0.3 * std::cos(y);
    state.x[i] *= 1.02;
  }
  return state;
}

State run(const std::string& method, double step, std::int64_t steps, const State& start) {
  const Problem problem = make_problem(rippling_scene(method, step), start);
  auto stepper = make_stepper(problem, make_plan(problem));
  stepper->advance(steps);
  return stepper->state();
}

double distance(const State& a, const State& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += std::pow(a.x[i] - b.x[i], 2) + std::pow(a.y[i] - b.y[i], 2);
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST_P(MethodTest, TableIsConsistent) {
  double kicks = 0.0, drifts = 0.0;
  for (const Stage& stage : method().stages) {
    kicks += stage.kick;
    drifts += stage.drift;
    if (&stage != &method().stages.back()) {
      EXPECT_NE(stage.drift, 0.0);
    }
  }
  EXPECT_DOUBLE_EQ(kicks, 1.0);
  EXPECT_DOUBLE_EQ(drifts, 1.0);
  EXPECT_EQ(method().first_same_as_last, method().stages.back().drift == 0.0);
  const auto stages = static_cast<int>(method().stages.size());
  EXPECT_EQ(method().evaluations, method().first_same_as_last ? stages - 1 : stages);
  EXPECT_FALSE(method().source.empty());
}

// Error at t = 0.2 s against the same method at a step 40 times smaller than the smallest; slope
// between steps a factor of two apart. 0.15: what the next term of the error leaves at these steps.
TEST_P(MethodTest, OrderIsTheSlopeOfTheError) {
  const State start = rippling_start();
  constexpr double end = 0.2;
  const auto at = [&](std::int64_t steps) {
    return run(GetParam(), end / static_cast<double>(steps), steps, start);
  };
  const State reference = at(80'000);
  const double coarse = distance(at(1000), reference);
  const double fine = distance(at(2000), reference);
  const double slope = std::log2(coarse / fine);
  EXPECT_NEAR(slope, method().order, 0.15) << coarse << " " << fine;
}

// There and back: velocities turned round. A reversible method is back but for rounding, 4000 steps
// of an ULP of 16 cm (3.6e-15 cm); another one is not.
TEST_P(MethodTest, IsReversibleAsDeclared) {
  const State start = rippling_start();
  constexpr std::int64_t steps = 2000;
  State turned = run(GetParam(), 1e-4, steps, start);
  for (double& v : turned.vx) v = -v;
  for (double& v : turned.vy) v = -v;
  const double off = distance(run(GetParam(), 1e-4, steps, turned), start);
  constexpr double rounding = 2 * steps * 3.6e-15;
  if (method().reversible) {
    EXPECT_LE(off, rounding);
  } else {
    EXPECT_GT(off, 100 * rounding);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MethodTest, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Method& m : methods()) names.emplace_back(m.name);
                           return names;
                         }()),
                         [](const auto& param) { return param.param; });

TEST(Methods, UnknownNameIsNull) { EXPECT_EQ(find_method("euler"), nullptr); }

}  // namespace
}  // namespace bounce
