// What each method's table declares, measured: generated for every method of the registry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/tests/kernels/method_names.hpp"

namespace bounce {
namespace {

class MethodTest : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] const Method& method() const { return *find_method(GetParam()); }
};

// A free ball: smooth motion on the scale of the largest steps below, omega_max = 1300 1/s.
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

// On its way down to the floor, which it would meet after 0.6 s.
Scene falling_scene(const std::string& method, double step) {
  Scene scene = rippling_scene(method, step);
  scene.gravity = {0.3, -9.8};
  scene.walls = {Wall{}};
  return scene;
}

// Turning, strained, and rippling in waves of some four bonds, stiff enough for an error of the
// sixth order to be seen above rounding. From rest the first-order error of the listing's scheme,
// half a step's kick at the start, would vanish; a strain of 2 % is chaos within 0.2 s.
State rippling_start() {
  State state = make_problem(rippling_scene("listing", 1e-4)).initial;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double x = state.x[i], y = state.y[i] - 10.0;
    state.vx[i] = -0.5 * y + 0.4 * std::sin(4.0 * x);
    state.vy[i] = 0.5 * x + 0.3 * std::cos(4.0 * y);
    state.x[i] *= 1.005;
  }
  return state;
}

State run(const Scene& scene, std::int64_t steps, const State& start) {
  const Problem problem = make_problem(scene, start);
  auto stepper = make_stepper(problem);
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

// Kicks and drifts in the order in which they are done, those of length 0 at the ends left out.
std::vector<double> parts_of(const Method& method) {
  std::vector<double> parts;
  for (const Stage& stage : method.stages) {
    parts.push_back(stage.kick);
    parts.push_back(stage.drift);
  }
  if (parts.front() == 0.0) parts.erase(parts.begin());
  if (parts.back() == 0.0) parts.pop_back();
  return parts;
}

TEST_P(MethodTest, TableIsConsistent) {
  double kicks = 0.0, drifts = 0.0;
  for (const Stage& stage : method().stages) {
    kicks += stage.kick;
    drifts += stage.drift;
    if (&stage != &method().stages.back()) {
      EXPECT_NE(stage.drift, 0.0);
    }
    if (&stage != &method().stages.front()) {
      EXPECT_NE(stage.kick, 0.0);
    }
  }
  EXPECT_DOUBLE_EQ(kicks, 1.0);
  EXPECT_DOUBLE_EQ(drifts, 1.0);
  const bool kick_to_kick = method().stages.back().drift == 0.0;
  const bool drift_to_drift = method().stages.front().kick == 0.0;
  EXPECT_FALSE(kick_to_kick && drift_to_drift);
  EXPECT_EQ(method().first_same_as_last, kick_to_kick || drift_to_drift);
  EXPECT_FALSE(method().source.empty());
}

TEST_P(MethodTest, EvaluatesTheForceAsOftenAsDeclared) {
  const StageSequence sequence = stage_sequence(method());
  EXPECT_EQ(sequence.joined.empty(), !method().first_same_as_last);
  const std::vector<Stage>& stages = sequence.joined.empty() ? sequence.fresh : sequence.joined;
  EXPECT_EQ(static_cast<int>(stages.size()), method().evaluations);
  EXPECT_EQ(sequence.fresh.size(), stages.size());
  for (const Stage& stage : stages) {
    EXPECT_NE(stage.kick, 0.0);
    EXPECT_NE(stage.drift, 0.0);
  }
}

// Read backwards a reversible method is itself, to the last bit.
TEST_P(MethodTest, IsAPalindromeIfReversible) {
  const std::vector<double> parts = parts_of(method());
  EXPECT_EQ(std::equal(parts.begin(), parts.end(), parts.rbegin()) && parts.size() % 2 == 1,
            method().reversible);
}

// The slope of the error at t = 0.1 s between steps a factor of two apart, in free flight and
// before impact. The reference is one for all methods, by the method of the highest order, with
// steps whose error is below its rounding: so all of them converge to the same. 0.15: what the next
// term of the error leaves at these steps.
TEST_P(MethodTest, OrderIsTheSlopeOfTheError) {
  const Method& finest =
      *std::max_element(methods().begin(), methods().end(),
                        [](const Method& a, const Method& b) { return a.order < b.order; });
  const State start = rippling_start();
  constexpr double end = 0.1;
  // omega dt = 0.26, or 1.3: at 500 steps an error of the sixth order would be rounding.
  const std::int64_t coarse = method().order > 4 ? 100 : 500;
  for (const auto& scene_of : {rippling_scene, falling_scene}) {
    const auto at = [&](std::string_view name, std::int64_t steps) {
      return run(scene_of(std::string(name), end / static_cast<double>(steps)), steps, start);
    };
    const State reference = at(finest.name, 2000);
    const double error = distance(at(GetParam(), coarse), reference);
    const double half = distance(at(GetParam(), 2 * coarse), reference);
    const double slope = std::log2(error / half);
    EXPECT_NEAR(slope, method().order, 0.15) << error << " " << half;
    RecordProperty(scene_of == rippling_scene ? "free_flight" : "before_impact",
                   std::to_string(slope));
  }
}

// There and back: velocities turned round. A reversible method is back but for rounding, an ULP of
// 16 cm (3.6e-15 cm) a drift; another one is not.
TEST_P(MethodTest, IsReversibleAsDeclared) {
  const State start = rippling_start();
  constexpr std::int64_t steps = 2000;
  const Scene scene = rippling_scene(GetParam(), 1e-4);
  State turned = run(scene, steps, start);
  for (double& v : turned.vx) v = -v;
  for (double& v : turned.vy) v = -v;
  const double off = distance(run(scene, steps, turned), start);
  const double rounding = 2 * steps * method().evaluations * 3.6e-15;
  if (method().reversible) {
    EXPECT_LE(off, rounding);
  } else {
    EXPECT_GT(off, 100 * rounding);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MethodTest, testing::ValuesIn(method_names()),
                         [](const auto& param) { return test_name(param.param); });

// The stages as they are run, in the papers' digits: kick, drift, kick ... Written from the papers
// (tables there give the first half; what the sum rules leave over has been worked out by hand to
// the same digits), so that a digit in the program's table is seen that its order would not show.
struct Published {
  const char* method;
  std::vector<double> parts;  // kicks and drifts by turns, beginning with a kick
};

std::vector<Published> published() {
  return {
      {"listing", {1.0, 1.0}},
      {"leapfrog", {0.5, 1.0, 0.5, 0.0}},
      // Yoshida 1990: 1/(2 - 2^(1/3)), and 1 less twice that.
      {"yoshida-4",
       {0.6756035959798289, 1.3512071919596578, -0.1756035959798288, -1.7024143839193153,
        -0.1756035959798288, 1.3512071919596578, 0.6756035959798289, 0.0}},
      // Omelyan, Mryglod, Folk 2002, PEFRL: xi, lambda, chi; (1 - 2 lambda)/2, 1 - 2 (chi + xi).
      {"pefrl",
       {0.0, 0.1786178958448091, 0.7123418310626054, -0.06626458266981849, -0.2123418310626054,
        0.7752933736500188, -0.2123418310626054, -0.06626458266981849, 0.7123418310626054,
        0.1786178958448091}},
      // Blanes and Moan 2002, table 3, SRKN_6^b.
      {"blanes-moan-4",
       {0.0829844064174052, 0.245298957184271, 0.396309801498368, 0.604872665711080,
        -0.0390563049223486, -0.350171622895351, 0.1195241940131508, -0.350171622895351,
        -0.0390563049223486, 0.604872665711080, 0.396309801498368, 0.245298957184271,
        0.0829844064174052, 0.0}},
      // The same table, SRKN_11^b.
      {"blanes-moan-6",
       {0.0414649985182624,  0.123229775946271,  0.198128671918067,   0.290553797799558,
        -0.0400061921041533, -0.127049212625417, 0.0752539843015807,  -0.246331761062075,
        -0.0115113874206879, 0.357208872795928,  0.2366699247869311,  0.20477705429147,
        0.2366699247869311,  0.357208872795928,  -0.0115113874206879, -0.246331761062075,
        0.0752539843015807,  -0.127049212625417, -0.0400061921041533, 0.290553797799558,
        0.198128671918067,   0.123229775946271,  0.0414649985182624,  0.0}},
  };
}

TEST(Methods, HaveThePublishedCoefficients) {
  constexpr double last_digit = 6e-16;  // of sums of up to ten of them, printed with 15 decimals
  EXPECT_EQ(published().size(), methods().size()) << "a new method has no digits here";
  for (const auto& [name, parts] : published()) {
    const Method* method = find_method(name);
    ASSERT_NE(method, nullptr) << name;
    ASSERT_EQ(2 * method->stages.size(), parts.size()) << name;
    for (std::size_t i = 0; i < method->stages.size(); ++i) {
      EXPECT_NEAR(method->stages[i].kick, parts[2 * i], last_digit) << name << ", kick " << i;
      EXPECT_NEAR(method->stages[i].drift, parts[2 * i + 1], last_digit) << name << ", drift " << i;
    }
  }
}

TEST(Methods, UnknownNameIsNull) { EXPECT_EQ(find_method("euler"), nullptr); }

}  // namespace
}  // namespace bounce
