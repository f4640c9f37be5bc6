// The reference solutions against problems with closed-form answers, and against each other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "verify/accuracy/reference_pair.hpp"
#include "verify/accuracy/reference_solution.hpp"
#include "verify/tests/paper_scenes.hpp"

namespace bounce {
namespace {

constexpr double stiffness_of_spring = 50.0;  // 1/s^2
constexpr double rest_of_spring = 1.0;        // cm

// Particles at rest, no bonds.
Problem particles(std::size_t n) {
  Problem problem;
  BondList none;
  none.start.assign(n + 1, 0);
  problem.bonds = none;
  problem.initial = State(n);
  return problem;
}

// Two particles and a bond that is an exact spring: -G R^1 + H R^0 is the law for p = -1, q = 0.
Problem spring() {
  Problem problem = particles(2);
  problem.bonds = BondList{{0, 1, 2}, {1, 0}, {0, 0}};
  problem.law = {-1.0, 0.0};
  problem.classes = {{stiffness_of_spring, stiffness_of_spring * rest_of_spring, rest_of_spring}};
  return problem;
}

Wall floor_with(double alpha, double beta) {
  Wall wall;
  wall.alpha = alpha;
  wall.beta = beta;
  return wall;
}

struct Solved {
  std::vector<State> states;
  ReferenceRun run;
};
enum class Way { adaptive, fixed };

Solved solve(Way way, const Problem& problem, const std::vector<double>& times,
             double fixed_step = 1e-3) {
  Solved solved;
  const auto keep = [&](double, const State& state) { solved.states.push_back(state); };
  solved.run = way == Way::adaptive ? solve_adaptive(problem, times, AdaptiveSettings{}, keep)
                                    : solve_fixed(problem, times, FixedSettings{fixed_step}, keep);
  return solved;
}

class ReferenceTest : public testing::TestWithParam<Way> {
 protected:
  // Some hundred steps, each with roundings of coordinates of some cm (adaptive: 2e-16 each);
  // events are placed to some roundings of the time.
  static constexpr double close = 2e-13;
};

TEST_P(ReferenceTest, SpringSwings) {
  Problem problem = spring();
  problem.initial.x = {-0.65, 0.65};
  problem.initial.vy = {0.25, 0.25};
  const std::vector<double> times{0.0, 0.7, 3.0};
  const Solved solved = solve(GetParam(), problem, times);
  ASSERT_EQ(solved.states.size(), times.size());
  const double omega = std::sqrt(2.0 * stiffness_of_spring);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const State& s = solved.states[k];
    EXPECT_NEAR(s.x[1] - s.x[0], rest_of_spring + 0.3 * std::cos(omega * times[k]), close);
    EXPECT_NEAR(s.vx[1] - s.vx[0], -0.3 * omega * std::sin(omega * times[k]), omega * close);
    EXPECT_NEAR(s.y[0], 0.25 * times[k], close);
  }
}

TEST_P(ReferenceTest, FallsOntoTheFloor) {
  Problem problem = particles(1);
  problem.gravity = {0.3, -0.5};
  problem.walls = {floor_with(0.0, 0.0)};
  problem.initial.y = {2.0};
  problem.initial.vx = {1.0};
  problem.initial.vy = {-0.3};
  const Solved solved = solve(GetParam(), problem, {1.0, 5.0});
  const double impact = (-0.3 + std::sqrt(0.09 + 2.0)) / 0.5;
  ASSERT_EQ(solved.run.events.size(), 1U);
  EXPECT_EQ(solved.run.events[0].kind, ContactKind::lands);
  EXPECT_NEAR(solved.run.events[0].time, impact, close);
  const State& end = solved.states.back();
  EXPECT_EQ(end.y[0], 0.0);
  EXPECT_EQ(end.vx[0], 0.0);
  EXPECT_NEAR(end.x[0], impact + 0.15 * impact * impact, close);
}

TEST_P(ReferenceTest, SlidesAlongAFrictionlessSlope) {
  Problem problem = particles(1);
  problem.gravity = {0.0, -1.0};
  Wall slope = floor_with(1.0, 0.0);
  slope.normal = {0.6, 0.8};
  problem.walls = {slope};
  problem.initial.x = {3.0};
  problem.initial.y = {1.0};  // 2.6 cm from the slope
  const Solved solved = solve(GetParam(), problem, {4.0});
  const double impact = std::sqrt(2.0 * 2.6 / 0.8);
  ASSERT_EQ(solved.run.events.size(), 1U);
  EXPECT_NEAR(solved.run.events[0].time, impact, close);
  // Along (0.8, -0.6) it is accelerated by 0.6 all the time.
  const State& end = solved.states.back();
  EXPECT_NEAR(0.8 * end.x[0] - 0.6 * end.y[0], 0.8 * 3.0 - 0.6 * 1.0 + 0.3 * 16.0, 10.0 * close);
  EXPECT_NEAR(0.6 * end.x[0] + 0.8 * end.y[0], 0.0, close);
  EXPECT_NEAR(0.6 * end.vx[0] + 0.8 * end.vy[0], 0.0, close);
}

// Ever lower bounces: 1/2 of the speed each, so an end in finite time.
TEST_P(ReferenceTest, ComesToRestAfterEverLowerBounces) {
  Problem problem = particles(1);
  problem.gravity = {0.0, -2.0};
  problem.walls = {floor_with(0.5, -0.5)};
  problem.initial.y = {1.0};
  problem.initial.vx = {1.0};
  const Solved solved = solve(GetParam(), problem, {1.6, 4.0});
  const auto& events = solved.run.events;
  ASSERT_GT(events.size(), 10U);
  EXPECT_EQ(events.back().kind, ContactKind::lands);
  EXPECT_EQ(std::count_if(events.begin(), events.end(),
                          [](const ContactEvent& e) { return e.kind == ContactKind::bounces; }),
            static_cast<std::ptrdiff_t>(events.size()) - 1);
  // Impact at t = 1 with speed 2; a flight takes 1, 1/2, 1/4 ... s, at 1/2, 1/4 ... cm/s along x.
  // What is cut off: bounces lower than height_cut, with flights up to 2 sqrt(2 h/g) and their sum
  // twice that; as long late may a landing be.
  const double cut = 4.0 * std::sqrt(solved.run.height_cut);
  EXPECT_NEAR(events.back().time, 3.0, 2.0 * cut);
  EXPECT_NEAR(events[0].time, 1.0, close);
  EXPECT_NEAR(events[1].time, 2.0, 10.0 * close);
  EXPECT_NEAR(solved.states[1].x[0], 1.0 + 0.5 / (1.0 - 0.25), cut);
  EXPECT_EQ(solved.states[1].y[0], 0.0);
  EXPECT_EQ(solved.states[1].vx[0], 0.0);
}

// A spring stands on its lower end, pressed together; in time it pulls that end off. All in closed
// form: one end held, then both free.
TEST_P(ReferenceTest, StandsStillUntilPulledOff) {
  const double g = 1.0, k = stiffness_of_spring, rest = rest_of_spring;
  Problem problem = spring();
  problem.gravity = {0.0, -g};
  problem.walls = {floor_with(0.0, 0.0)};
  problem.initial.y = {0.0, 0.7};
  const double swing = 0.7 - rest + g / k, omega = std::sqrt(k);
  const double release = std::acos(2.0 * g / (k * swing)) / omega;
  const Solved solved = solve(GetParam(), problem, {0.5 * release, release + 0.2});
  const auto& events = solved.run.events;
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(std::tuple(events[0].kind, events[0].time), std::tuple(ContactKind::lands, 0.0));
  EXPECT_EQ(events[1].kind, ContactKind::releases);
  EXPECT_NEAR(events[1].time, release, close);
  EXPECT_EQ(solved.states[0].y[0], 0.0);
  EXPECT_EQ(solved.states[0].vy[0], 0.0);
  EXPECT_NEAR(solved.states[0].y[1], rest - g / k + swing * std::cos(0.5 * omega * release), close);
  // The upper end as it was then; the middle falls, the length swings at sqrt(2) omega.
  const double y = rest + g / k, v = -swing * omega * std::sin(omega * release), t = 0.2;
  const double middle = 0.5 * (y + v * t - g * t * t), fast = std::sqrt(2.0) * omega;
  const double length = rest + g / k * std::cos(fast * t) + v / fast * std::sin(fast * t);
  EXPECT_NEAR(solved.states[1].y[0], middle - 0.5 * length, 10.0 * close);
  EXPECT_NEAR(solved.states[1].y[1], middle + 0.5 * length, 10.0 * close);
}

// Pulled along the wall, too: with friction it does not give way.
TEST_P(ReferenceTest, SticksAgainstAPullAlongTheWall) {
  Problem problem = spring();
  problem.gravity = {0.0, -40.0};
  problem.walls = {floor_with(0.9, 0.0)};
  problem.initial.x = {0.0, 0.6};
  problem.initial.y = {0.0, 0.9};
  const Solved stuck = solve(GetParam(), problem, {0.05});
  ASSERT_EQ(stuck.run.events.size(), 1U);
  EXPECT_EQ(stuck.states[0].x[0], 0.0);
  EXPECT_EQ(stuck.states[0].vx[0], 0.0);
  problem.walls = {floor_with(1.0, 0.0)};
  const Solved slid = solve(GetParam(), problem, {0.05});
  ASSERT_EQ(slid.run.events.size(), 1U);
  EXPECT_NE(slid.states[0].x[0], 0.0);
  EXPECT_NEAR(slid.states[0].x[0] + slid.states[0].x[1], 0.6, close);
  EXPECT_EQ(slid.states[0].y[0], 0.0);
}

// The lower end of a swinging spring is behind the wall for a hundredth of the fixed step.
TEST_P(ReferenceTest, SeesAContactThatEndsWithinAStep) {
  const double omega = std::sqrt(2.0 * stiffness_of_spring), step = 0.5 / omega;
  Problem problem = spring();
  problem.walls = {floor_with(1.0, -1.0)};
  const double depth = 1e-7;
  problem.initial.y = {0.3 - depth, 0.3 - depth + 0.7};  // shortest now, longest in half a period
  const double contact = std::acos(-(1.0 - depth / 0.15)) / omega;
  ASSERT_LT(3.14159 / omega - contact, 0.01 * step);
  const Solved solved = solve(GetParam(), problem, {0.47}, step);
  ASSERT_GE(solved.run.events.size(), 1U);
  // A time at which something nearly turns: roundings of a place count by the root.
  const double place = GetParam() == Way::adaptive ? 1e-14 : 1e-7 /* of this coarse step */;
  EXPECT_NEAR(solved.run.events[0].time, contact, place / (omega * std::sqrt(0.3 * depth)));
}

TEST_P(ReferenceTest, ElasticFloorKeepsTheEnergy) {
  Problem problem = spring();
  problem.gravity = {0.0, -3.0};
  problem.walls = {floor_with(1.0, -1.0)};
  problem.initial.x = {0.0, 0.4};
  problem.initial.y = {1.0, 2.0};
  problem.initial.vx = {0.5, 0.5};
  const auto energy = [](const State& s) {
    const double stretch = std::hypot(s.x[1] - s.x[0], s.y[1] - s.y[0]) - rest_of_spring;
    double sum = 0.5 * stiffness_of_spring * stretch * stretch;
    for (std::size_t i = 0; i < 2; ++i) {
      sum += 0.5 * (s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i]) + 3.0 * s.y[i];
    }
    return sum;
  };
  const Solved solved = solve(GetParam(), problem, {0.0, 2.0, 6.0});
  ASSERT_GE(solved.run.events.size(), 3U);
  for (const ContactEvent& event : solved.run.events) {
    EXPECT_EQ(event.kind, ContactKind::bounces);
  }
  // Of 10 erg; positions as good as `close` in forces of some 50.
  EXPECT_NEAR(energy(solved.states[1]), energy(solved.states[0]), 50.0 * close);
  EXPECT_NEAR(energy(solved.states[2]), energy(solved.states[0]), 50.0 * close);
  EXPECT_NEAR(0.5 * (solved.states[2].vx[0] + solved.states[2].vx[1]), 0.5, close);
}

// As the paper's rule does in its first step.
TEST_P(ReferenceTest, AStartBehindAnElasticWallIsMirrored) {
  Problem problem = particles(1);
  problem.walls = {floor_with(1.0, -1.0)};
  problem.initial.y = {-5e-5};
  problem.initial.vx = {2.0};
  problem.initial.vy = {-1.0};
  const Solved solved = solve(GetParam(), problem, {0.5});
  EXPECT_NEAR(solved.states[0].y[0], 0.5 + 5e-5, close);
  EXPECT_NEAR(solved.states[0].x[0], 1.0, close);
}

std::string refusal(Way way, const Problem& problem) {
  try {
    solve(way, problem, {2.0});
  } catch (const ReferenceError& error) {
    return error.what();
  }
  return "none";
}

TEST_P(ReferenceTest, RefusesWhatItCannotSolve) {
  Problem behind = particles(2);
  behind.walls = {floor_with(0.0, 0.0)};
  behind.initial.y = {1.0, -5e-5};
  EXPECT_EQ(refusal(GetParam(), behind).find("particle 2 starts"), 0U);

  Problem corner = particles(1);
  corner.gravity = {0.0, -1.0};
  corner.walls = {floor_with(1.0, 0.0), floor_with(1.0, 0.0)};
  corner.walls[1].normal = {-1.0, 0.0};
  corner.walls[1].offset = -1.0;
  corner.initial.y = {0.1};
  corner.initial.vx = {1.0};
  EXPECT_EQ(refusal(GetParam(), corner).find("particle 1 slides along wall[0] into wall[1]"), 0U);

  Problem nothing = spring();
  nothing.initial.x = {0.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_NE(refusal(GetParam(), nothing).find("not finite"), std::string::npos);

  const Problem fine = spring();
  EXPECT_THROW(solve(GetParam(), fine, {1.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(solve(GetParam(), fine, {std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> times{1.0};
  EXPECT_THROW(solve_adaptive(fine, times, {nan}, [](double, const State&) {}),
               std::invalid_argument);
  EXPECT_THROW(solve_fixed(fine, times, {nan}, [](double, const State&) {}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(BothWays, ReferenceTest, testing::Values(Way::adaptive, Way::fixed),
                         [](const auto& way) {
                           return way.param == Way::adaptive ? "adaptive" : "fixed";
                         });

TEST(FixedReferenceTest, HasOrderSix) {
  Problem problem = spring();
  problem.initial.x = {0.0, 0.8};
  problem.initial.vy = {-1.0, 1.0};  // it turns, so that the problem is not linear
  const double end = 2.0;
  const State exact = solve(Way::fixed, problem, {end}, 1e-3).states[0];
  std::vector<double> errors;
  const std::vector<double> steps{0.1, 0.05, 0.025};
  for (const double step : steps) {
    errors.push_back(largest_distance(solve(Way::fixed, problem, {end}, step).states[0], exact));
  }
  // The next term of the error is of order 8: (omega step)^2 = 1, 1/4, 1/16 of the first one's
  // size.
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 6.0, 1.0);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 6.0, 0.25);
}

// Example 1 from just above the axis at the speed of its impact.
Problem soft_landing() {
  Scene scene = paper_scene(1);
  scene.ball.centre.y = 7.01;
  scene.ball.velocity.y = -0.767;
  return make_problem(scene);
}

std::vector<double> times_to(double end) {
  std::vector<double> times;
  for (int k = 0; k * 0.02 < end + 1e-9; ++k) times.push_back(k * 0.02);
  return times;
}

TEST(ReferencePairTest, AGrowthThatIsNoNumberStaysOne) {
  State ball(1), lost(1);
  ball.x[0] = lost.x[0] = 1.0;
  lost.y[0] = std::nan("");
  DisturbedPair paths;
  paths.pair.times = {0.0, 1.0, 2.0};
  paths.pair.adaptive.states = {ball, ball, ball};
  paths.pair.fixed = paths.pair.adaptive;
  paths.disturbed.states = {ball, lost, ball};
  EXPECT_TRUE(std::isnan(growth_of(paths).greatest));
}

TEST(ReferencePairTest, RoundingsAreThoseOfTheLargestCoordinate) {
  Problem problem = soft_landing();
  const double size = rounding_disturbance(problem);
  const double moved = largest_distance(disturbed_start(problem, size), problem.initial);
  EXPECT_GT(moved, 0.0);
  EXPECT_LT(moved, 1e-13);  // 15 cm: an ulp is 1.8e-15
  for (double& x : problem.initial.x) x += 1e6;
  EXPECT_NEAR(rounding_disturbance(problem) / size, 1e5, 4e4);
}

TEST(ReferencePairTest, AgreesThroughTheFirstContactsOfExample1) {
  const Problem problem = soft_landing();
  const DisturbedPair both = solve_disturbed(problem, times_to(0.2), {}, 1e-9);
  const ReferencePair& pair = both.pair;
  auto adaptive = pair.adaptive.run.events, fixed = pair.fixed.run.events;
  ASSERT_GE(fixed.size(), 3U);
  ASSERT_EQ(adaptive.size(), fixed.size());
  // The two of a mirror pair may come in either order.
  const auto by_particle = [](const ContactEvent& a, const ContactEvent& b) {
    return std::tuple(a.particle, a.time) < std::tuple(b.particle, b.time);
  };
  std::sort(adaptive.begin(), adaptive.end(), by_particle);
  std::sort(fixed.begin(), fixed.end(), by_particle);
  // The first particle to arrive hops for 1.5e-4 s and lands at some 1e-6 cm/s: a rounding of its
  // place, 1e-14 cm, is 1e-8 s.
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    EXPECT_EQ(adaptive[k].particle, fixed[k].particle);
    EXPECT_EQ(adaptive[k].kind, fixed[k].kind);
    EXPECT_NEAR(adaptive[k].time, fixed[k].time, 1e-8);
  }
  // 50 times the tolerance times 14 cm (AdaptiveSettings), with some room for what contacts make of
  // it.
  EXPECT_LE(largest_distance(pair.adaptive.states.back(), pair.fixed.states.back()), 1e-11);
  EXPECT_EQ(pair.first_contact(),
            std::min(pair.adaptive.run.events[0].time, pair.fixed.run.events[0].time));
  EXPECT_LT(pair.times[pair.last_before_contact()], pair.first_contact());
  EXPECT_GE(pair.times[pair.last_before_contact() + 1], pair.first_contact());

  const Growth growth = growth_of(both);
  EXPECT_LE(growth.start, std::sqrt(2.0) * 1e-9);
  EXPECT_GT(growth.start, 0.5e-9);  // the largest of 360
  EXPECT_GE(growth.greatest, growth.end);
  EXPECT_TRUE(std::isfinite(growth.rate));
}

TEST(ReferencePairTest, TheErrorBarShrinksWithTolerances) {
  const Problem problem = soft_landing();
  const std::vector<double> times = times_to(0.1);
  const double step = default_reference_step(problem);
  const auto bar = [&](double tolerance, double of_step) {
    const ReferencePair pair = solve_both(problem, times, {{tolerance}, {of_step * step}});
    EXPECT_FALSE(pair.fixed.run.events.empty());
    return largest_distance(pair.adaptive.states.back(), pair.fixed.states.back());
  };
  const double coarse = bar(1e-8, 4.0), middle = bar(1e-10, 2.0), fine = bar(1e-12, 1.0);
  // Half the step is 1/64 of the error, and the tolerance goes down by 100.
  EXPECT_LT(middle, coarse / 20.0);
  EXPECT_LT(fine, middle / 20.0);
  EXPECT_GT(fine, 0.0);
}

TEST(ReferencePairTest, WithoutContactsAndStopped) {
  Problem problem = spring();
  problem.initial.x = {0.0, 1.1};
  const std::vector<double> times{0.0, 0.5, 1.0};
  const ReferencePair pair = solve_both(problem, times, {{}, {1e-3}});
  EXPECT_EQ(pair.first_contact(), 1.0);
  EXPECT_EQ(pair.last_before_contact(), 2U);
  struct Stop {};
  EXPECT_THROW(solve_both(problem, times, {{}, {1e-3}}, [] { throw Stop{}; }), Stop);
}

TEST(ReferencePairTest, DistancesPassNoNan) {
  State a(2), b(2);
  b.x[0] = std::numeric_limits<double>::quiet_NaN();
  b.x[1] = 1.0;
  EXPECT_TRUE(std::isnan(largest_distance(a, b)));
}

}  // namespace
}  // namespace bounce
