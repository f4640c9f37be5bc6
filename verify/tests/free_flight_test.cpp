// Free flight: within a window nobody reaches a wall, whatever the speeds, the bonds and the step;
// and a run that leaves out the wall test there has the bits of one that does not.
#include "kernels/stepping/free_flight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/stepping/method.hpp"
#include "kernels/stepping/plan.hpp"

namespace bounce {
namespace {

constexpr double paper_step = 1e-6, paper_e = 16000.0;  // s; Example 2

// From `first` on, below `end`.
std::vector<double> growing(double first, double end, double factor) {
  std::vector<double> values{first};
  while (values.back() * factor < end) values.push_back(values.back() * factor);
  return values;
}

// Example 2's ball.
Scene ball_scene() {
  Scene scene;
  scene.constants = Constants::double_precision;
  scene.law.rest = Rest::geometry;
  scene.walls = {Wall{}};
  return scene;
}

std::size_t lowest(const State& state) {
  const auto least = std::min_element(state.y.begin(), state.y.end());
  return static_cast<std::size_t>(least - state.y.begin());
}

// The scene's ball with `gap` between it and y = 0.
Problem ball_above(double gap, const Scene& scene = ball_scene()) {
  Problem problem = make_problem(scene);
  const double shift = gap - problem.initial.y[lowest(problem.initial)];
  for (double& y : problem.initial.y) y += shift;
  return problem;
}

// The same stiffness a step at any E.
Scene with_e(Scene scene, double e, double part = 1.0) {
  scene.law.elasticity = e;
  scene.time.step = part * paper_step * std::sqrt(paper_e / e);
  scene.time.end = 1e6 * scene.time.step;
  scene.output.monitor_every = scene.time.end;
  return scene;
}

Problem with_method(Problem problem, const Method& method) {
  problem.method = &method;
  return problem;
}

// Down, and the highest one up where `both`, so that their common motion is none.
void fire(State& state, double speed, bool both) {
  state.vy[lowest(state)] = -speed;
  const auto most = std::max_element(state.y.begin(), state.y.end());
  if (both) state.vy[static_cast<std::size_t>(most - state.y.begin())] = speed;
}

void squeeze(State& state, double factor) {  // about the lowest point
  const double floor = state.y[lowest(state)];
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.x[i] *= factor;
    state.y[i] = floor + factor * (state.y[i] - floor);
  }
}

// What a kernel's survey must find, plainly.
FlightSurvey survey_of(const Problem& problem, const FreeFlight& flight, const State& state) {
  FlightSurvey survey = flight.nothing_seen();
  survey.finite = true;
  survey.gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < state.size(); ++i) {
    survey.vx.add(state.vx[i]);
    survey.vy.add(state.vy[i]);
    survey.reach = std::max({survey.reach, std::abs(state.x[i]), std::abs(state.y[i])});
    for (const Wall& wall : problem.walls) {
      survey.gap = std::min(survey.gap, wall_distance(wall, state.x[i], state.y[i]));
    }
    problem.bonds.visit_row(i, [&](std::size_t j, std::size_t bond_class) {
      const double dx = state.x[i] - state.x[j], dy = state.y[i] - state.y[j];
      survey.r2[bond_class].add(dx * dx + dy * dy);
    });
  }
  return survey;
}

// One stage without walls, written as plainly as can be.
void plain_stage(const Problem& problem, const Stage& stage, State& state) {
  const State from = state;
  for (std::size_t i = 0; i < from.size(); ++i) {
    double ax = problem.gravity.x, ay = problem.gravity.y;
    problem.bonds.visit_row(i, [&](std::size_t j, std::size_t bond_class) {
      const double dx = from.x[i] - from.x[j], dy = from.y[i] - from.y[j];
      const double f =
          force_over_distance(problem.law, problem.classes[bond_class], dx * dx + dy * dy);
      ax += f * dx;
      ay += f * dy;
    });
    state.vx[i] += stage.kick * problem.step * ax;
    state.vy[i] += stage.kick * problem.step * ay;
    state.x[i] += stage.drift * problem.step * state.vx[i];
    state.y[i] += stage.drift * problem.step * state.vy[i];
  }
}

// A window's claim, stage by stage, at most `most_steps` of them. Returns the window's steps.
std::int64_t check_window(const Problem& problem, State state, std::int64_t most_steps = 2048) {
  const FreeFlight flight(problem);
  const FlightSurvey survey = survey_of(problem, flight, state);
  const FreeFlight::Window window = flight.window(survey);
  const State start = state;
  Vec2 velocity{0.5 * (survey.vx.least + survey.vx.greatest),
                0.5 * (survey.vy.least + survey.vy.greatest)};
  Vec2 common{};
  for (std::int64_t s = 0; s < std::min(window.steps, most_steps); ++s) {
    for (const Stage& stage : problem.method->stages) {
      plain_stage(problem, stage, state);
      velocity.x += stage.kick * problem.step * problem.gravity.x;
      velocity.y += stage.kick * problem.step * problem.gravity.y;
      common.x += stage.drift * problem.step * velocity.x;
      common.y += stage.drift * problem.step * velocity.y;
    }
    double departure = 0.0, gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < state.size(); ++i) {
      departure = std::max(departure, std::hypot(state.x[i] - start.x[i] - common.x,
                                                 state.y[i] - start.y[i] - common.y));
      for (const Wall& wall : problem.walls) {
        gap = std::min(gap, wall_distance(wall, state.x[i], state.y[i]));
      }
    }
    EXPECT_LE(departure, window.departure) << "at step " << s + 1 << " of " << window.steps;
    EXPECT_GT(gap, 0.0) << "at step " << s + 1 << " of " << window.steps;
    if (testing::Test::HasFailure()) break;
  }
  return window.steps;
}

TEST(FreeFlight, LastsLongOnThePapersBall) {
  for (const double e : {1000.0, 16000.0}) {
    Scene scene;
    scene.law.elasticity = e;
    scene.walls = {Wall{}};
    for (const Method& method : methods()) {
      const Problem problem = with_method(make_problem(scene), method);
      // A window is so many steps over the root of the sums of |kick| and |drift|.
      double kicks = 0.0, drifts = 0.0;
      for (const Stage& stage : method.stages) {
        kicks += std::abs(stage.kick);
        drifts += std::abs(stage.drift);
      }
      const auto window = static_cast<double>(check_window(problem, problem.initial));
      EXPECT_GE(window * std::sqrt(kicks * drifts), 512.0) << e << ", " << method.name;
    }
  }
}

TEST(FreeFlight, HoldsForAParticleFiredAtTheWall) {
  int flights = 0;
  for (const double e : {1e-6, 1.0, 16000.0, 1e12}) {
    for (const double gap : growing(1e-3, 0.03, 1.29)) {
      const Problem start = ball_above(gap, with_e(ball_scene(), e));
      for (const Method& method : methods()) {
        Problem problem = with_method(start, method);
        for (const bool both : {false, true}) {
          fire(problem.initial, 6.7e-6 / problem.step, both);  // 150 to 4500 steps to the wall
          flights += check_window(problem, problem.initial) > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GE(flights, 50);
}

TEST(FreeFlight, HoldsForSqueezedBondsAndStrongGravity) {
  int flights = 0;
  for (const double e : {1e-6, 16000.0, 1e12}) {
    for (const double part : {0.003, 0.03, 1.0, 30.0}) {
      for (const double factor : {0.3, 0.7, 0.97, 1.5}) {
        for (const double gap : {1e-3, 0.3}) {
          Scene scene = with_e(ball_scene(), e, part);
          scene.gravity = {3000.0, -1e4};
          Problem problem = ball_above(gap, scene);
          squeeze(problem.initial, factor);
          flights += check_window(problem, problem.initial, 512) > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GE(flights, 20);
}

TEST(FreeFlight, IsNotGivenWhereNothingIsKnown) {
  const Problem problem = ball_above(1.0);
  const FreeFlight flight(problem);
  const FlightSurvey good = survey_of(problem, flight, problem.initial);
  const auto steps = [&](const auto& spoil) {
    FlightSurvey survey = good;
    spoil(survey);
    return flight.window(survey).steps;
  };
  EXPECT_GT(steps([](FlightSurvey&) {}), 0);
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(steps([](FlightSurvey& s) { s.finite = false; }), 0);
  for (const double bad : {nan, inf, -inf, 1e300}) {
    EXPECT_EQ(steps([bad](FlightSurvey& s) {
                s.r2[0].greatest = bad;
                s.r2[0].least = bad;
              }),
              0);
    EXPECT_EQ(steps([bad](FlightSurvey& s) { s.vx.greatest = bad; }), 0);
    EXPECT_EQ(steps([bad](FlightSurvey& s) { s.vy.least = -bad; }), 0);
    EXPECT_EQ(steps([bad](FlightSurvey& s) { s.reach = bad; }), 0);
  }
  for (const double bad : {nan, -inf, 0.0, -1.0, 1e-15}) {
    EXPECT_EQ(steps([bad](FlightSurvey& s) { s.gap = bad; }), 0);
  }
}

TEST(FlightTurns, TakesWhatIsLeftOfAWindowBeforeItAsksAgain) {
  const Problem problem = ball_above(1.0);
  const FreeFlight flight(problem);
  const FlightSurvey far = survey_of(problem, flight, problem.initial);
  const std::int64_t window = flight.window(far).steps;
  FlightTurns turns(problem);
  int surveys = 0;
  std::int64_t free = 0, walled = 0;
  double gap = far.gap;
  const auto take = [&](std::int64_t steps) {
    turns.advance(
        steps,
        [&](FlightSurvey& survey) {
          survey = far;
          survey.gap = gap;
          ++surveys;
        },
        [&](std::int64_t n, bool is_free) { (is_free ? free : walled) += n; });
  };
  take(100);
  for (int i = 100; i < window; ++i) take(1);
  EXPECT_EQ(surveys, 1);
  EXPECT_EQ(free, window);
  take(1);  // too few to ask for
  EXPECT_EQ(surveys, 1);
  EXPECT_EQ(walled, 1);
  gap = 0.0;
  take(5000);
  EXPECT_EQ(free, window);
  EXPECT_EQ(walled, 5001);
  EXPECT_LE(surveys, 11);
  gap = far.gap;
  turns.forget();
  take(100);
  EXPECT_EQ(free, window + 100);
}

// Steppers of one kernel with and without free flight, side by side.
class Pair {
 public:
  Pair(const Problem& problem, const std::string& kernel, int threads) {
    PlanRequest request;
    request.kernel = kernel;
    request.threads = threads;
    free_ = make_stepper(problem, make_plan(problem, request));
    request.free_flight = false;
    tested_ = make_stepper(problem, make_plan(problem, request));
  }
  void restore(const Snapshot& snapshot) {
    free_->restore(snapshot);
    tested_->restore(snapshot);
  }
  [[nodiscard]] Snapshot save() const { return free_->save(); }
  void advance(std::int64_t steps) {
    free_->advance(steps);
    tested_->advance(steps);
  }
  [[nodiscard]] bool same() const {
    return state_hash(free_->state()) == state_hash(tested_->state());
  }

 private:
  std::unique_ptr<Stepper> free_, tested_;
};

// Steps in uneven pieces, restored once on the way.
void expect_same_bits(const Problem& problem, std::int64_t steps, int most_threads = 1) {
  for (const char* kernel : {"ring", "mirror", "csr"}) {
    const bool half = std::string(kernel) == "mirror";
    PlanRequest request;
    request.kernel = kernel;
    if (half) {
      try {
        (void)make_plan(problem, request);
      } catch (const PlanError&) {
        continue;  // not symmetric
      }
    }
    for (int threads = 1; threads <= most_threads; ++threads) {
      Pair pair(problem, kernel, threads);
      pair.advance(1);
      pair.advance(steps / 3);
      EXPECT_TRUE(pair.same()) << kernel << ", " << threads << " threads, a third";
      pair.restore(pair.save());
      pair.advance(7);
      pair.advance(steps - steps / 3 - 8);
      EXPECT_TRUE(pair.same()) << kernel << ", " << threads << " threads";
    }
  }
}

// Almost no bonds: a window is as long as the flight to the wall allows. Distances of all
// mantissas, so that a bound half of what it must be gives some window that ends behind the wall.
TEST(FreeFlightBits, OfABallShotAtTheWall) {
  for (const double steps_to_wall : growing(150.0, 3000.0, 1.19)) {
    Scene scene = with_e(ball_scene(), 1e-6);
    scene.time.step = 1e-3;
    scene.ball.velocity.y = -100.0;
    scene.walls.front().beta = -1.0;
    scene.walls.front().alpha = 1.0;
    expect_same_bits(ball_above(0.1 * steps_to_wall, scene),
                     static_cast<std::int64_t>(1.5 * steps_to_wall), steps_to_wall < 220.0 ? 2 : 1);
  }
}

TEST(FreeFlightBits, OfAParticleFiredAtTheWall) {
  for (const double e : {1e-6, 16000.0, 1e12}) {
    for (const double gap : growing(1e-3, 7e-3, 1.19)) {
      const Problem start = ball_above(gap, with_e(ball_scene(), e));
      for (const Method& method : methods()) {
        Problem problem = with_method(start, method);
        for (const bool both : {false, true}) {
          fire(problem.initial, 6.7e-6 / problem.step, both);
          expect_same_bits(problem, 1200);
        }
      }
    }
  }
}

TEST(FreeFlightBits, OfSqueezedBallsAtAnyElasticityAndStep) {
  for (const double e : {1e-6, 1.0, 16000.0, 1e12}) {
    for (const double part : {0.003, 0.1, 1.0, 100.0, 1e6}) {
      for (const double factor : {0.5, 0.9}) {
        Scene scene = with_e(ball_scene(), e, part);
        scene.gravity.y = -1e4;
        scene.walls = {Wall{{0.0, 1.0}, 0.0, 0.5, -0.5}};
        Problem problem = ball_above(1e-3, scene);
        squeeze(problem.initial, factor);
        expect_same_bits(problem, 1500);
      }
    }
  }
}

TEST(FreeFlightBits, BetweenWallsBackwardsBehindAWallAndWithoutNumbers) {
  Scene scene = ball_scene();
  scene.ball.velocity = {3.0, -8.0};
  const double h = std::sqrt(0.5);
  for (const Method& method : methods()) {
    Problem problem = with_method(ball_above(0.01, scene), method);
    problem.walls = {Wall{{h, h}, -2.06, 0.3, -0.7}, Wall{{0.0, 1.0}, 0.0, 0.9, -1.0},
                     Wall{{-1.0, 0.0}, -7.02, 0.0, 0.0}, Wall{{0.0, -1.0}, -14.05, 0.0, -0.3}};
    expect_same_bits(problem, 4000, 2);
    problem.walls[1].contact = Contact::resolved;
    expect_same_bits(problem, 4000);
    Problem backwards = problem;
    backwards.step = -problem.step;
    expect_same_bits(backwards, 3000);
    Problem behind = problem;
    behind.initial.y[300] = -0.5;
    expect_same_bits(behind, 1500);
    Problem far = ball_above(3.0);
    far.initial.y[17] = std::numeric_limits<double>::quiet_NaN();
    expect_same_bits(far, 300);
    far = ball_above(3.0);
    far.initial.vx[5] = std::numeric_limits<double>::infinity();
    expect_same_bits(far, 300);
  }
}

// Other rings, laws and neighbourhoods, which have surveys of their own.
TEST(FreeFlightBits, OfOtherBalls) {
  Scene scene = ball_scene();
  scene.ball.velocity.y = -8.0;
  for (const auto& [p, q] : {std::pair{7.0, 13.0}, {2.0, 4.0}}) {
    scene.law.p = p;
    scene.law.q = q;
    expect_same_bits(ball_above(0.01, scene), 4000);
  }
  scene.law = LawSpec{.rest = Rest::geometry};
  for (const std::vector<double>& radii : {std::vector{7.0}, {6.0, 7.0}, {4.0, 5.0, 6.0, 7.0}}) {
    scene.ball.radii = radii;
    expect_same_bits(ball_above(0.01, scene), 4000);
  }
  scene.ball.radii = {5.0, 6.0, 7.0};
  scene.ball.per_ring = 72;  // half of it does not divide into lanes
  expect_same_bits(ball_above(0.01, scene), 4000);
  scene.ball.kind = BallKind::disc;
  scene.ball.radii = {2.0};
  scene.ball.spacing = 0.25;
  const Problem disc = ball_above(0.01, scene);
  Pair pair(disc, "csr", 2);
  pair.advance(4000);
  EXPECT_TRUE(pair.same());
}

TEST(FreeFlightPlan, SaysThatTheTestIsLeftOut) {
  const auto says = [](const Plan& plan) {
    const std::string text = "wall test while no particle can reach a wall";
    return std::find(plan.left_out.begin(), plan.left_out.end(), text) != plan.left_out.end();
  };
  Scene scene = ball_scene();
  PlanRequest request;
  for (const char* kernel : {"ring", "mirror", "csr"}) {
    request.kernel = kernel;
    EXPECT_TRUE(says(make_plan(make_problem(scene), request))) << kernel;
  }
  for (const char* kernel : {"strict", "rings"}) {
    request.kernel = kernel;
    EXPECT_FALSE(says(make_plan(make_problem(scene), request))) << kernel;
  }
  request.kernel = "ring";
  request.free_flight = false;
  EXPECT_FALSE(says(make_plan(make_problem(scene), request)));
  request.free_flight = true;
  scene.walls.clear();
  EXPECT_FALSE(says(make_plan(make_problem(scene), request)));
}

TEST(FreeFlightPlan, ServesTheProblemWithoutItsWallsToo) {
  const Problem problem = make_problem(ball_scene());
  for (const char* kernel : {"ring", "mirror", "csr"}) {
    PlanRequest request;
    request.kernel = kernel;
    const Plan plan = make_plan(problem, request);
    Problem open = problem;
    open.walls.clear();
    auto with = make_stepper(problem, plan), without = make_stepper(open, plan);
    with->advance(600);
    without->advance(600);
    EXPECT_EQ(state_hash(with->state()), state_hash(without->state())) << kernel;
  }
}

}  // namespace
}  // namespace bounce
