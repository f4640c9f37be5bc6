// Greenspan's completely conservative method keeps what it is named after, at a step no explicit
// method could take; its order; and that it can be run backwards.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/accuracy/conservative.hpp"
#include "verify/accuracy/reference_solution.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/vibrations/spectrum.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {
namespace {

constexpr double epsilon = 2.22e-16;

// Example 1's ball in the air, without gravity, struck: its right half moves at 0.3 cm/s against
// the rest, and it turns.
Problem struck_ball(double step) {
  Scene scene = paper_scene(1);
  scene.walls.clear();
  scene.gravity = {};
  scene.ball.velocity = {0.4, -0.7};
  scene.constants = Constants::double_precision;
  scene.time.step = step;
  Problem problem = make_problem(scene);
  State& s = problem.initial;
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.vx[i] += -0.05 * (s.y[i] - 10.0) + (s.x[i] > 0.0 ? 0.3 : 0.0);
    s.vy[i] += 0.05 * s.x[i];
  }
  return problem;
}

double edge(const Problem& problem) {
  return 2.0 / fastest_vibration(problem, problem.initial)->omega;
}

// Bounds. A step rounds each coordinate (10 cm), velocity (1 cm/s) and force; what that does to a
// conserved sum is at most
//   momentum: n roundings of a velocity, angular momentum: those times 10 cm, and n v roundings of
//   a coordinate, energy: n v times a rounding of a velocity, and bonds times the force of a bond
//   (below 50 dyn: 0.05 R0 of stretch at E = 1000) times a rounding of a coordinate,
// a step, all in one direction. They are of either sign, so in fact the sums are far nearer.
TEST(Conservative, KeepsEnergyMomentumAndAngularMomentumBeyondTheEdge) {
  const double step = 5.0 * edge(struck_ball(1e-3));
  const Problem problem = struck_ball(step);
  ConservativeStepper stepper(problem);
  const Sample before = measure(problem, problem.initial);
  constexpr int steps = 2000;
  constexpr double n = 360.0, speed = 1.5, size = 20.0;
  double bend = 0.0;
  for (int k = 0; k < steps; k += 100) {
    stepper.advance(100);
    const Sample now = measure(problem, stepper.state());
    const double taken = k + 100;
    const double momentum = taken * n * speed * epsilon;
    EXPECT_NEAR(now.momentum.x, before.momentum.x, momentum);
    EXPECT_NEAR(now.momentum.y, before.momentum.y, momentum);
    EXPECT_NEAR(now.angular_momentum, before.angular_momentum, 2.0 * size * momentum);
    EXPECT_NEAR(now.total(), before.total(),
                speed * momentum + taken * 840.0 * 50.0 * size * epsilon);
    bend = std::max(bend, std::abs(now.bond - before.bond));
  }
  EXPECT_GT(bend, 1.0) << "erg: bonds gave and took, or nothing was tried";
}

State at(double time, double step) {
  const Problem problem = struck_ball(step);
  ConservativeStepper stepper(problem);
  stepper.advance(std::llround(time / step));
  return stepper.state();
}

// Halving the step divides the error by 4. At 1/10 of the edge the next term, of relative size
// (omega dt)^2 = 0.04, is what moves the ratio: 10 % is allowed.
TEST(Conservative, IsOfOrderTwo) {
  const double time = 0.064;
  const Problem problem = struck_ball(1e-3);
  State exact;
  solve_fixed(problem, std::vector<double>{time}, {}, [&](double, const State& s) { exact = s; });
  const double coarse = largest_distance(at(time, 2e-4), exact);
  const double fine = largest_distance(at(time, 1e-4), exact);
  EXPECT_GT(coarse, 1e-7) << "cm: else roundings would be compared";
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, std::log2(1.1));
}

// There, all velocities turned round, and back. Each of the 2 x 200 steps rounds a coordinate of
// up to 20 cm; what a step forgets grows no faster than a vibration, whose amplitudes a rounding of
// a velocity reaches through 1/omega of the slowest (10 rad/s) only: 400 x 20 epsilon x 100 with
// room.
TEST(Conservative, RunsBackwards) {
  const Problem problem = struck_ball(3.0 * edge(struck_ball(1e-3)));
  ConservativeStepper stepper(problem);
  const auto turn_round = [&] {
    Snapshot snapshot = stepper.save();
    for (double& v : snapshot.state.vx) v = -v;
    for (double& v : snapshot.state.vy) v = -v;
    stepper.restore(snapshot);
  };
  stepper.advance(200);
  EXPECT_GT(largest_distance(stepper.state(), problem.initial), 0.1);
  turn_round();
  stepper.advance(200);
  turn_round();
  const double off = largest_distance(stepper.state(), problem.initial);
  EXPECT_TRUE(off <= 400 * 20 * epsilon * 100) << off;
}

// A pressed particle rests under the resolved rule, as in wall_rule_test; the ball loses its energy
// to the floor and comes up.
TEST(Conservative, MeetsTheWallByBothRules) {
  for (const Contact contact : {Contact::listing, Contact::resolved}) {
    Scene scene = paper_scene(1);
    scene.ball.centre.y = 7.002;
    scene.ball.velocity = {0.0, -0.77};
    scene.walls.front().contact = contact;
    scene.time.step = 1e-3;
    const Problem problem = make_problem(scene);
    ConservativeStepper stepper(problem);
    stepper.advance(100);
    EXPECT_TRUE(is_finite(stepper.state()));
    for (const double y : stepper.state().y) EXPECT_GE(y, 0.0);
    EXPECT_LT(measure(problem, stepper.state()).total(),
              measure(problem, problem.initial).total() - 0.1);
  }
}

TEST(Conservative, RefusesOtherLaws) {
  Scene scene = paper_scene(1);
  scene.law.q = 7.0;
  scene.law.rest = Rest::geometry;
  const Problem problem = make_problem(scene);
  EXPECT_NE(conservative_refusal(problem), "");
  EXPECT_THROW(ConservativeStepper{problem}, std::invalid_argument);
}

}  // namespace
}  // namespace bounce
