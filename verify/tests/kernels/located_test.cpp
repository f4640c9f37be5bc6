// Contact "located": the method's order through contacts, the rules, one answer.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/contact/located.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/accuracy/reference_solution.hpp"
#include "verify/stability/bounce_run.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"
#include "verify/watch/ledger.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {
namespace {

// Example 2's ball just above the floor, and not its own mirror image if it moves along it.
Scene impact_scene(double alpha, double beta, const std::string& method, double step,
                   double along = 0.3) {
  Scene scene = paper_scene(2);
  scene.ball.centre.y = 7.02;
  scene.ball.velocity = {along, -1.0};
  scene.ball.rounding = Rounding::none;
  scene.law.rest = Rest::geometry;
  scene.constants = Constants::double_precision;
  for (Wall& wall : scene.walls) {
    wall.alpha = alpha;
    wall.beta = beta;
    wall.contact = Contact::located;
  }
  scene.time.method = method;
  scene.time.step = step;
  return scene;
}

std::unique_ptr<Stepper> stepper_of(const Problem& problem, const PlanRequest& request = {}) {
  return make_stepper(problem, request);
}

State after(const Scene& scene, std::int64_t steps, const PlanRequest& request = {}) {
  const auto stepper = stepper_of(make_problem(scene), request);
  stepper->advance(steps);
  return stepper->state();
}

// Time enough for the lowest particles to land, rest, and bounce or be pulled off.
constexpr double watched = 0.06;  // s

// A fifth of the fastest vibration's time: an error of 1e-14 cm by the order of the reference.
constexpr double truth_step = 4e-5;  // s

struct Truth {
  State end;
  ReferenceRun run;
};
Truth truth_of(const Scene& scene, double time) {
  Truth truth;
  truth.run = solve_fixed(make_problem(scene), std::vector{time}, {truth_step},
                          [&](double, const State& state) { truth.end = state; });
  return truth;
}

// ---- order

constexpr double coarse = 2e-4;  // s; half of leapfrog's stable step

// Method, order, and a step at which its errors neither are as large as the vibrations (a step of
// the listing's scheme puts their phase off by some omega dt) nor roundings.
class LocatedOrder : public testing::TestWithParam<std::tuple<std::string, int, double>> {};

// Error(dt) / error(dt/4) is 4^order. Contacts begin and end anywhere within steps, so that the
// factor is not smooth: half an order is left for that. Some thousand evaluations leave roundings
// of coordinates of 7 cm, 1e-15 each.
TEST_P(LocatedOrder, IsThatOfTheMethodThroughContacts) {
  constexpr double roundings = 3e-13;  // cm
  const auto& [method, order, step] = GetParam();
  for (const auto& [alpha, beta] : {std::pair{0.0, 0.0}, std::pair{1.0, -1.0}}) {
    SCOPED_TRACE(beta);
    const Truth truth = truth_of(impact_scene(alpha, beta, method, step), watched);
    ASSERT_GE(truth.run.events.size(), 4U);
    std::vector<double> errors;
    for (const double dt : {step, step / 4.0}) {
      const State end = after(impact_scene(alpha, beta, method, dt), std::llround(watched / dt));
      errors.push_back(largest_distance(end, truth.end));
    }
    const double least = std::pow(4.0, order - 0.5);
    EXPECT_LE(errors[1], errors[0] / least + roundings) << errors[0] << " and " << errors[1];
    EXPECT_GT(errors[0], 300.0 * roundings);  // else the roundings would decide
  }
}

INSTANTIATE_TEST_SUITE_P(
    Methods, LocatedOrder,
    testing::Values(std::tuple("listing", 1, 4e-6), std::tuple("leapfrog", 2, 1e-4),
                    std::tuple("yoshida-4", 4, 1e-4), std::tuple("pefrl", 4, 2e-4),
                    std::tuple("blanes-moan-4", 4, 2e-4), std::tuple("blanes-moan-6", 6, 5e-4)),
    [](const auto& param) {
      std::string name = std::get<0>(param.param);
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

// By resolved contact the same method has errors of first order there; so this test would notice.
TEST(Located, IsNotWhatResolvedIs) {
  const Scene scene = impact_scene(1.0, -1.0, "blanes-moan-6", coarse);
  Scene resolved = scene;
  resolved.walls.front().contact = Contact::resolved;
  const std::int64_t steps = std::llround(watched / coarse);
  const Truth truth = truth_of(scene, watched);
  const double by_located = largest_distance(after(scene, steps), truth.end);
  const double by_resolved = largest_distance(after(resolved, steps), truth.end);
  EXPECT_GT(by_resolved, 100.0 * by_located);
}

// ---- rules

// All that alpha and beta may be: bounces that end in rest, sliding, half friction. At this step
// the method leaves 2e-13 cm (order test); bounces that end in rest do so some roundings earlier or
// later, 2e-12 cm. Resolved contact is off by 2e-7 cm and more. (That the rules are the paper's is
// for reference_test to say: a reference finds its contacts by the same code.)
TEST(Located, FollowsTheRules) {
  for (const auto& [alpha, beta] :
       {std::pair{0.5, -0.5}, std::pair{1.0, 0.0}, std::pair{0.0, -1.0}, std::pair{0.3, 0.0}}) {
    SCOPED_TRACE(testing::Message() << alpha << ", " << beta);
    const Scene scene = impact_scene(alpha, beta, "blanes-moan-6", coarse / 4.0);
    const Truth truth = truth_of(scene, watched);
    EXPECT_GE(truth.run.events.size(), 4U);
    Scene resolved = scene;
    resolved.walls.front().contact = Contact::resolved;
    const std::int64_t steps = std::llround(watched / scene.time.step);
    EXPECT_LE(largest_distance(after(scene, steps), truth.end), 1e-11);
    EXPECT_GT(largest_distance(after(resolved, steps), truth.end), 1e-7);
  }
}

// Elastic walls take no energy, and a floor no momentum along it: Blanes and Moan's method leaves
// of the total what its order leaves, an error far below what a single bounce at the wrong time
// makes.
TEST(Located, ElasticWallsTakeNothing) {
  const Scene scene = impact_scene(1.0, -1.0, "blanes-moan-6", coarse / 4.0);
  const Problem problem = make_problem(scene);
  const Sample start = measure(problem, problem.initial);
  const State end = after(scene, std::llround(watched / scene.time.step));
  const Sample now = measure(problem, end);
  EXPECT_NEAR(now.total(), start.total(), 1e-6);
  EXPECT_NEAR(now.momentum.x, start.momentum.x, 1e-9);
  EXPECT_GT(std::abs(now.momentum.y - start.momentum.y), 1.0);  // it did meet the floor
}

// A ball that comes down into a wedge.
TEST(Located, TakesSeveralWalls) {
  Scene scene = impact_scene(1.0, -1.0, "blanes-moan-6", 1e-4, 0.0);
  scene.walls.push_back(scene.walls.front());
  scene.walls[0].normal = {0.6, 0.8};
  scene.walls[1].normal = {-0.6, 0.8};
  for (Wall& wall : scene.walls) wall.offset = 0.8 * scene.ball.centre.y - 7.02;
  const Truth truth = truth_of(scene, watched);
  for (const std::size_t wall : {0U, 1U}) {
    EXPECT_TRUE(std::any_of(truth.run.events.begin(), truth.run.events.end(),
                            [&](const ContactEvent& event) { return event.wall == wall; }));
  }
  // As above.
  EXPECT_LE(largest_distance(after(scene, 600), truth.end), 1e-11);
}

// A ball squeezed, at rest: no speed tells that it will reach the floor, and without gravity
// nothing but its bonds.
TEST(Located, SeesASqueezedBallComing) {
  for (const double gravity : {-0.098, 0.0}) {
    Scene scene = impact_scene(0.0, 0.0, "blanes-moan-6", 1e-4);
    scene.gravity.y = gravity;
    scene.ball.centre.y = 7.0;
    Problem problem = make_problem(scene);
    for (std::size_t i = 0; i < problem.initial.size(); ++i) {
      problem.initial.y[i] = 7.0 + 0.998 * (problem.initial.y[i] - 7.0);  // 0.014 cm above
      problem.initial.vx[i] = problem.initial.vy[i] = 0.0;
    }
    Truth truth;
    truth.run = solve_fixed(problem, std::vector{watched}, {truth_step},
                            [&](double, const State& state) { truth.end = state; });
    ASSERT_GT(truth.run.events.size(), 0U);
    const auto stepper = stepper_of(problem, {"ring"});
    stepper->advance(std::llround(watched / scene.time.step));        // it touches after 0.026 s
    EXPECT_LE(largest_distance(stepper->state(), truth.end), 1e-10);  // roundings make 1e-12
  }
}

// Four decimals can put a start behind a wall.
TEST(Located, PutsAStartBehindTheWallOntoIt) {
  Scene scene = impact_scene(0.0, 0.0, "leapfrog", coarse);
  scene.ball.centre.y = 7.0 - 5e-5;
  const Problem problem = make_problem(scene);
  const std::size_t lowest = std::min_element(problem.initial.y.begin(), problem.initial.y.end()) -
                             problem.initial.y.begin();
  ASSERT_LT(problem.initial.y[lowest], 0.0);
  const State end = after(scene, 1);
  EXPECT_EQ(end.y[lowest], 0.0);
  EXPECT_EQ(std::tuple(end.vx[lowest], end.vy[lowest]), std::tuple(0.0, 0.0));
}

// One that is behind it and comes out, as a flight that was too long may leave it, keeps its speed.
TEST(Located, LetsOutWhatIsBehindTheWall) {
  Problem problem = make_problem(impact_scene(0.0, 0.0, "leapfrog", 1e-6));
  const auto lowest = static_cast<std::size_t>(
      std::min_element(problem.initial.y.begin(), problem.initial.y.end()) -
      problem.initial.y.begin());
  problem.initial.y[lowest] = -1e-3;
  problem.initial.vy[lowest] = 2.0;
  const auto stepper = stepper_of(problem, {"ring"});
  stepper->advance(1);
  const State end = stepper->state();
  // Its bonds push it down by some 2000 cm/s^2 for 1e-6 s.
  EXPECT_NEAR(end.y[lowest], 2.0 * 1e-6, 1e-8);
  EXPECT_NEAR(end.vy[lowest], 2.0, 0.05);
}

// Five times the stable step, particles flung at the floor; and a place that is no number, which is
// handed out as such.
TEST(Located, AWildRunEnds) {
  const Scene scene = impact_scene(0.5, -0.5, "leapfrog", 2e-3);
  const State wild = after(scene, 3000);
  EXPECT_GT(*std::max_element(wild.y.begin(), wild.y.end()), 100.0);
  Problem problem = make_problem(impact_scene(0.0, 0.0, "leapfrog", coarse));
  problem.initial.x[5] = std::nan("");
  for (const char* const kernel : {"ring", "csr"}) {
    const auto stepper = stepper_of(problem, {kernel});
    stepper->advance(300);
    EXPECT_FALSE(is_finite(stepper->state())) << kernel;
  }
  // It becomes one in flight, on the kernel of half balls, which takes nothing that is not
  // symmetric.
  Scene falls = impact_scene(0.0, 0.0, "leapfrog", coarse, 0.0);
  falls.ball.rounding = Rounding::listing;
  Problem half = make_problem(falls);
  ASSERT_EQ(make_plan(half).inside, "mirror");
  half.gravity.y = std::nan("");
  const auto stepper = stepper_of(half, {"mirror"});
  stepper->advance(300);
  EXPECT_FALSE(is_finite(stepper->state()));
}

// ---- one answer

struct OneAnswer : testing::Test {
  // It falls, meets the floor at step 180 or so, is near it for some hundred steps, and leaves.
  Scene scene = impact_scene(0.0, 0.0, "leapfrog", coarse);
  OneAnswer() { scene.ball.centre.y = 7.04; }
  static constexpr std::int64_t steps = 6000;
};

TEST_F(OneAnswer, FliesWithTheKernelsBits) {
  Scene open = scene;
  open.walls.clear();
  EXPECT_TRUE(same_state(after(scene, 60, {"ring"}), after(open, 60, {"ring"})));
}

TEST_F(OneAnswer, SameBitsForThreadsAndVectors) {
  for (const char* const kernel : {"ring", "csr"}) {
    const State expected = after(scene, steps, {kernel, "auto", 1});
    EXPECT_TRUE(same_state(after(scene, steps, {kernel, "auto", 2}), expected)) << kernel;
    for (const VectorTarget target : available_vectors()) {
      EXPECT_TRUE(
          same_state(after(scene, steps, {kernel, std::string(name_of(target)), 1}), expected))
          << kernel << ", " << name_of(target);
    }
  }
}

TEST_F(OneAnswer, SameBitsHoweverItIsDealtOut) {
  for (const char* const method : {"listing", "leapfrog", "pefrl"}) {
    SCOPED_TRACE(method);
    scene.time.method = method;
    const Problem problem = make_problem(scene);
    const State expected = after(scene, steps);
    auto stepper = stepper_of(problem);
    for (std::int64_t done = 0, part = 1; done < steps; part = part * 3 % 101 + 1) {
      const std::int64_t now = std::min(part, steps - done);
      stepper->advance(now);
      done += now;
      (void)stepper->state();
      auto other = stepper_of(problem);  // a restart, in flight and at the floor
      other->restore(stepper->save());
      ASSERT_EQ(other->step(), done);
      stepper = std::move(other);
    }
    EXPECT_TRUE(same_state(stepper->state(), expected));
  }
}

TEST_F(OneAnswer, ASymmetricBallStaysSo) {
  scene.ball.velocity.x = 0.0;
  scene.ball.rounding = Rounding::listing;  // on exact circles the two sides differ by roundings
  const Problem problem = make_problem(scene);
  ASSERT_EQ(make_plan(problem).inside, "mirror");
  const State end = after(scene, steps);
  const State whole = after(scene, steps, {"ring"});
  // The kernels differ by roundings, some 1e-13 cm by then, which the bounce may make 50 000 times
  // larger.
  EXPECT_LE(largest_distance(end, whole), 1e-8);
  EXPECT_GT(largest_distance(end, problem.initial), 0.1);
}

// ---- refusals

TEST(Located, RefusesWhatItCannotRun) {
  const auto refusal = [](const Scene& scene) -> std::string {
    try {
      make_plan(make_problem(scene));
    } catch (const PlanError& error) {
      return error.what();
    }
    return {};
  };
  Scene scene = impact_scene(1.0, 0.0, "leapfrog", coarse);
  EXPECT_EQ(refusal(scene), "");
  scene.walls.push_back(scene.walls.front());
  scene.walls.back().normal = {1.0, 0.0};
  scene.walls.back().offset = -20.0;
  EXPECT_NE(refusal(scene).find("slides along one wall"), std::string::npos);
  EXPECT_THROW(make_plan(make_problem(impact_scene(0.0, 0.0, "listing", coarse)), {"strict"}),
               PlanError);
}

TEST(Located, WrapsTheKernelThatIsForcedAndNoOther) {
  const Problem problem = make_problem(impact_scene(0.0, 0.0, "leapfrog", coarse));
  const Plan plan = make_plan(problem, {"csr"});
  EXPECT_EQ(plan.kernel, "located");
  EXPECT_EQ(plan.inside, "csr");
  EXPECT_EQ(kernel_name(plan), "located (csr)");
  EXPECT_TRUE(plan.cuts_steps);
  EXPECT_EQ(make_plan(problem, {"located"}).inside, make_plan(problem).inside);
  Problem other = problem;
  other.walls.front().contact = Contact::resolved;
  EXPECT_EQ(make_plan(other).inside, "");
  EXPECT_FALSE(make_plan(other).cuts_steps);
  EXPECT_THROW(make_plan(other, {"located"}), PlanError);
  other.walls.clear();
  EXPECT_THROW(make_plan(other, {"located"}), PlanError);
}

TEST(Located, IsForAllWallsOrNone) {
  Scene scene = impact_scene(0.0, 0.0, "leapfrog", coarse);
  scene.walls.push_back(scene.walls.front());
  scene.walls.back().offset = -1.0;
  scene.walls.back().contact = Contact::resolved;
  try {
    validate(scene);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_EQ(error.key, "wall[1].contact");
  }
}

}  // namespace
}  // namespace bounce
