// GSL's stiff steppers as baselines, on a ball small enough for their dense matrices: what they are
// told of the motion, that they solve it, and what they refuse. (accuracy_test.cpp has the others.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "verify/accuracy/baseline.hpp"
#include "verify/accuracy/gsl_flow.hpp"
#include "verify/accuracy/reference_pair.hpp"

namespace bounce {
namespace {

// 36 particles some 3 cm apart: vibrations up to 30 1/s.
Scene small_scene() {
  Scene scene;
  scene.law.elasticity = 1000.0;
  scene.law.rest = Rest::geometry;
  scene.ball.per_ring = 12;
  scene.ball.rounding = Rounding::none;
  return scene;
}

// Stretched by a tenth along x, so that it vibrates.
Problem vibrating() {
  Problem problem = make_problem(small_scene());
  for (double& x : problem.initial.x) x *= 1.1;
  return problem;
}

struct Solved {
  std::vector<State> states;
  BaselineWork work;
};
using Solver = decltype(Baseline::solve);

const Solver& solver_named(std::string_view name) {
  for (const Baseline& baseline : baselines()) {
    if (baseline.name == name) return baseline.solve;
  }
  throw std::invalid_argument(std::string(name));
}
const Solver& rk8pd() { return solver_named("gsl-rk8pd"); }
Solved solve(const Solver& solver, const Problem& problem, double tolerance) {
  std::vector<double> times;
  for (int i = 0; i <= 2; ++i) times.push_back(0.5 * i);
  Solved solved;
  solved.work = solver(
      problem, tolerance, times,
      [&](double, const State& state) { solved.states.push_back(state); }, [] {}, nullptr);
  return solved;
}

// Against difference quotients, at a state in which one particle sticks to the floor and one slides
// along a wall. Central ones with h = 1e-4 cm are off by (h/R)^2 of the derivative and by the
// rounding of a rate over h: parts of 1e-8.
TEST(GslJacobian, IsTheDerivativeOfTheRates) {
  Problem problem = vibrating();
  problem.walls = {Wall{}, Wall{{std::sqrt(0.5), std::sqrt(0.5)}, -20.0, 1.0, 0.0}};
  const std::size_t n = problem.initial.size(), all = 4 * n;
  Resting resting(problem);
  resting.put(3, 0);
  resting.put(17, 1);
  GslFlow flow(problem, gsl_odeiv2_step_bsimp, 1e-6);
  std::vector<double> state;
  for (const auto* part :
       {&problem.initial.x, &problem.initial.y, &problem.initial.vx, &problem.initial.vy}) {
    state.insert(state.end(), part->begin(), part->end());
  }
  flow.begin(state, resting);
  std::vector<double> by_state(all * all, -1.0), by_time(all, -1.0), above(all), below(all);
  ASSERT_EQ(GslFlow::jacobian(0.0, state.data(), by_state.data(), by_time.data(), &flow), 0);
  double largest = 0.0, off = 0.0;
  for (std::size_t k = 0; k < all; ++k) {
    constexpr double h = 1e-4;
    std::vector<double> moved = state;
    moved[k] += h;
    GslFlow::derivative(0.0, moved.data(), above.data(), &flow);
    moved[k] -= 2 * h;
    GslFlow::derivative(0.0, moved.data(), below.data(), &flow);
    for (std::size_t i = 0; i < all; ++i) {
      const double quotient = (above[i] - below[i]) / (2 * h);
      largest = std::max(largest, std::abs(quotient));
      off = std::max(off, std::abs(by_state[i * all + k] - quotient));
    }
  }
  EXPECT_GT(largest, 100.0);  // 1/s^2: ten vibrations' worth
  EXPECT_LT(off, 1e-7 * largest);
  EXPECT_EQ(std::count(by_time.begin(), by_time.end(), 0.0), static_cast<std::ptrdiff_t>(all));
}

class StiffBaseline : public testing::TestWithParam<std::string> {
 protected:
  static const Solver& solver() {
    return solver_named(GetParam() == "gsl_msbdf" ? "gsl-msbdf" : "gsl-bsimp");
  }
};

// In free flight, against rk8pd. A step may be off by the tolerance times the ball's 14 cm; what
// hundreds of steps of a method of low order make of that in a vibration of 30 1/s is allowed
// twenty such errors.
TEST_P(StiffBaseline, AgreesWithRk8pdInFlight) {
  const Problem problem = vibrating();
  const Solved fine = solve(rk8pd(), problem, 1e-12);
  double last = 0.0;
  for (const double tolerance : {1e-5, 1e-8}) {
    const Solved solved = solve(solver(), problem, tolerance);
    ASSERT_EQ(solved.states.size(), fine.states.size());
    EXPECT_GT(solved.work.steps, 4);
    double off = 0.0;
    for (std::size_t k = 0; k < fine.states.size(); ++k) {
      off = std::max(off, largest_distance(solved.states[k], fine.states[k]));
    }
    EXPECT_LT(off, 20.0 * tolerance * 14.0) << tolerance;
    if (last > 0.0) {
      EXPECT_LT(off, last / 10.0) << "at a thousandth of the tolerance";
    }
    last = off;
  }
  EXPECT_GT(largest_distance(fine.states.back(), fine.states.front()), 0.1) << "nothing moved";
}

// On the floor, with friction and without: events are cut out of their steps, particles held.
TEST_P(StiffBaseline, MeetsAFloorAsRk8pdDoes) {
  for (const double alpha : {0.0, 1.0}) {
    Scene scene = small_scene();
    scene.ball.centre.y = 7.1;  // so that steps are long when it arrives, and cut in parts
    scene.ball.velocity = {0.3, -0.77};
    scene.walls = {Wall{}};
    scene.walls[0].alpha = alpha;
    scene.walls[0].contact = Contact::resolved;
    const Problem problem = make_problem(scene);
    const Solved fine = solve(rk8pd(), problem, 1e-12), solved = solve(solver(), problem, 1e-8);
    Problem open = problem;
    open.walls.clear();
    EXPECT_GT(largest_distance(solve(rk8pd(), open, 1e-12).states.back(), fine.states.back()), 0.1)
        << "it met no floor";
    const double off = largest_distance(solved.states.back(), fine.states.back());
    EXPECT_LT(off, 20.0 * 1e-8 * 14.0);
  }
}

TEST_P(StiffBaseline, RefusesBallsWhoseMatricesAreTooLarge) {
  Scene scene = small_scene();
  scene.ball.per_ring = 334;
  const Problem problem = make_problem(scene);
  EXPECT_THROW(solve(solver(), problem, 1e-4), ReferenceError);
}

INSTANTIATE_TEST_SUITE_P(All, StiffBaseline, testing::Values("gsl_msbdf", "gsl_bsimp"),
                         [](const auto& of) { return of.param; });

// What a solver refuses is said in the row.
TEST(Baseline, ARefusalIsInItsRow) {
  Scene scene = small_scene();
  scene.ball.per_ring = 334;
  scene.time.end = 0.1;
  const Sampling sampling{0.01, 10};
  for (const Baseline& baseline : baselines()) {
    if (baseline.name != "gsl-bsimp") continue;
    const auto rows = measure_baseline(baseline, scene, {}, sampling, {}, {2, 10.0, 0.0}, [] {});
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NE(rows[0].row.note.find("at most 1000 particles"), std::string::npos)
        << rows[0].row.note;
    EXPECT_TRUE(std::isinf(rows[0].row.errors.observables.height));
  }
}

}  // namespace
}  // namespace bounce
