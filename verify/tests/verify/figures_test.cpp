// The figures of a bounce, against courses that are known in closed form, and against a search step
// by step that shares nothing with the gauge but the kernel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "kernels/plan/plan.hpp"
#include "verify/accuracy/reference_solution.hpp"
#include "verify/figures/bounce_gauge.hpp"
#include "verify/figures/contact_gauge.hpp"
#include "verify/figures/shape.hpp"
#include "verify/oracle/oracle_stepper.hpp"
#include "verify/tests/kernels/kernel_scenes.hpp"
#include "verify/watch/booking_stepper.hpp"

namespace bounce {
namespace {

// A small ball at rest, `above` the floor (its lowest particle), with steps of 1e-4 s.
Scene small_scene(double above) {
  Scene scene;
  scene.constants = Constants::double_precision;
  scene.ball.radii = {1.0, 2.0};
  scene.ball.per_ring = 12;
  scene.ball.rounding = Rounding::none;
  scene.law.elasticity = 1000.0;
  scene.law.rest = Rest::geometry;
  scene.gravity = {0.0, -98.0};
  scene.walls = {Wall{}};
  scene.time.step = 1e-4;
  scene.time.end = 0.3;
  scene.ball.centre.y = 0.0;
  const State ball = make_problem([&] {
                       Scene open = scene;
                       open.walls.clear();
                       return open;
                     }())
                         .initial;
  scene.ball.centre.y = above - *std::min_element(ball.y.begin(), ball.y.end());
  return scene;
}

Scene with(Scene scene, const std::string& method, Contact contact, double step) {
  scene.time.method = method;
  scene.time.step = step;
  for (Wall& wall : scene.walls) wall.contact = contact;
  return scene;
}

struct Found {
  Bounce bounce;
  std::optional<double> first_contact;
};
// `stops`: the run is stopped there, too, as for samples.
Found figures_of(const Scene& scene, std::int64_t stops = 0, bool again = true) {
  const Problem problem = make_problem(scene);
  const Plan plan = make_plan(problem, {"auto", "auto", 1});
  const auto stepper = plan.make_stepper();
  BounceGauge gauge(problem, scene.time.step, again ? remake(plan) : ActFinder::Make{});
  const std::int64_t end = scene.steps_until(scene.time.end);
  gauge.look(*stepper);
  while (stepper->step() < end) {
    std::int64_t next = std::min(end, gauge.next(stepper->step()));
    if (stops > 0) next = std::min(next, (stepper->step() / stops + 1) * stops);
    stepper->advance(next - stepper->step());
    if (gauge.due(next) || next == end) gauge.look(*stepper);
  }
  return {gauge.result(), gauge.first_contact()};
}

// Every step looked at. Acts: the steps in which the books grow.
struct BruteForce {
  std::optional<std::int64_t> first, last;
  double lowest = 1e9, flattest = 0.0;
  double lowest_time = 0.0;
};
BruteForce brute_force(const Scene& scene) {
  const Problem problem = make_problem(scene);
  const Plan plan = make_plan(problem, {"auto", "auto", 1});
  const auto stepper = make_booking_stepper(scene, problem, plan);
  BruteForce found;
  const int rings =
      scene.ball.kind == BallKind::rings ? static_cast<int>(scene.ball.radii.size()) : 1;
  for (std::int64_t step = 0;; ++step) {
    const State state = stepper->state();
    const Sample sample = measure(problem, state);
    if (sample.centre.y < found.lowest) {
      found.lowest = sample.centre.y;
      found.lowest_time = static_cast<double>(step) * scene.time.step;
    }
    found.flattest = std::max(found.flattest, measure_shape(state, rings).flattening);
    if (step == scene.steps_until(scene.time.end)) return found;
    const std::int64_t before = stepper->books().reflections();
    stepper->advance(1);
    if (stepper->books().reflections() == before) continue;
    if (!found.first) found.first = step;
    found.last = step;
  }
}

TEST(Figures, FirstContactOfAFallIsExact) {
  const double above = 0.3;
  const double exact = std::sqrt(2.0 * above / 98.0);
  for (const char* method : {"leapfrog", "blanes-moan-4", "blanes-moan-6"}) {
    for (const Contact contact : {Contact::listing, Contact::resolved, Contact::located}) {
      for (const double step : {1e-4, 1e-3}) {
        const Scene scene = with(small_scene(above), method, contact, step);
        const auto first = figures_of(scene).bounce.first_contact;
        ASSERT_TRUE(first) << method;
        // The ball falls without vibrating, so the methods are exact but for roundings.
        EXPECT_NEAR(first->value, exact, 1e-12) << method << " " << step;
        EXPECT_LE(first->found_to, 1e-9) << method << " " << step;
      }
    }
  }
  // The listing's method falls g dt^2 n (n + 1)/2 in n steps: as far as the parabola half a step
  // later.
  const Scene scene = with(small_scene(above), "listing", Contact::listing, 1e-4);
  EXPECT_NEAR(figures_of(scene).bounce.first_contact->value, exact - 0.5e-4, 2e-8);
}

TEST(Figures, ApexOfAThrowIsExact) {
  Scene scene = small_scene(0.5);
  scene.walls.clear();
  scene.ball.velocity = {1.0, 7.0};
  scene.time.end = 0.2;
  for (const char* method : {"leapfrog", "blanes-moan-6"}) {
    const Bounce bounce = figures_of(with(scene, method, Contact::listing, 1e-3)).bounce;
    const double apex = scene.ball.centre.y + 49.0 / (2.0 * 98.0);
    EXPECT_NEAR(bounce.rebound_height->value, scene.ball.centre.y, 1.0);  // from the lowest on
    EXPECT_FALSE(bounce.first_contact);
    EXPECT_EQ(bounce.contact_time->value, 0.0);
    // From the start, so that the lowest is the start's height and the apex comes after it.
    scene.time.end = 0.1;
    const Bounce up = figures_of(with(scene, method, Contact::listing, 1e-3)).bounce;
    EXPECT_NEAR(up.rebound_height->value, apex, 1e-13) << method;
    EXPECT_LE(up.rebound_height->found_to, 1e-13);
    EXPECT_NEAR(up.lowest_centre->value, scene.ball.centre.y, 1e-13);
    scene.time.end = 0.2;
  }
}

struct Case {
  std::string name;
  Scene scene;
};
std::vector<Case> cases() {
  const auto walled = [](double alpha, double beta) {
    Scene scene = small_scene(0.3);
    scene.walls[0].alpha = alpha;
    scene.walls[0].beta = beta;
    return scene;
  };
  Scene slope = walled(0.3, 0.0);
  slope.walls[0] = Wall{{0.6, 0.8}, -2.0, 0.3, 0.0};
  slope.ball.centre = {0.0, 0.4};
  Scene two = walled(0.3, 0.0);
  two.ball.velocity.x = 5.0;
  two.walls.push_back({{-0.8, 0.6}, -2.6, 0.5, -0.5});
  Scene lid = walled(1.0, -1.0);
  lid.walls.push_back({{0.0, -1.0}, -4.6, 1.0, -1.0});
  lid.ball.velocity.y = 8.0;
  Scene disc = walled(0.0, 0.0);
  disc.ball.kind = BallKind::disc;
  disc.ball.radii = {1.0};
  disc.ball.spacing = 0.5;
  disc.ball.centre.y = 1.3;
  return {{"sticks", walled(0.0, 0.0)},
          {"slides", walled(1.0, 0.0)},
          {"half elastic", walled(0.5, -0.5)},
          {"elastic", walled(1.0, -1.0)},
          {"starts on the floor",
           [] {
             Scene scene = small_scene(0.0);
             scene.time.end = 0.1;
             return scene;
           }()},
          {"slope", slope},
          {"two walls", two},
          {"floor and lid", lid},
          {"disc", disc},
          {"leapfrog", with(walled(0.0, 0.0), "leapfrog", Contact::listing, 1e-4)},
          {"resolved", with(walled(0.0, 0.0), "leapfrog", Contact::resolved, 1e-4)},
          {"blanes-moan-4", with(walled(0.5, -0.5), "blanes-moan-4", Contact::resolved, 2e-4)},
          {"stage held with a drift", with(walled(1.0, 0.0), "pefrl", Contact::listing, 2e-4)}};
}

// Acts to the step that they are in. Extremes not below what any step has, and not above by more
// than they say and what may lie within a step: accelerations are below 1e4 cm/s^2, and a strike,
// which may come anywhere within it, changes the centre's speed by 1.2 cm/s at most (2 x 14/24).
TEST(Figures, AgreeWithASearchStepByStep) {
  for (const Case& each : cases()) {
    const double step = each.scene.time.step;
    const Bounce bounce = figures_of(each.scene).bounce;
    const BruteForce brute = brute_force(each.scene);
    ASSERT_TRUE(brute.first) << each.name;
    ASSERT_TRUE(bounce.first_contact) << each.name;
    const double first = static_cast<double>(*brute.first) * step;
    EXPECT_GE(bounce.first_contact->value, first - 1e-12) << each.name;
    EXPECT_LE(bounce.first_contact->value, first + step + 1e-12) << each.name;
    // What is held may be let go some steps after it was mirrored last.
    const double last = static_cast<double>(*brute.last) * step;
    EXPECT_GE(bounce.last_contact->value, last - 1e-12) << each.name;
    EXPECT_LE(bounce.last_contact->value, last + 9.0 * step) << each.name;
    const double bend = 0.125 * 1e4 * step * step + 0.25 * 1.2 * step;
    EXPECT_LE(bounce.lowest_centre->value, brute.lowest + 1e-13) << each.name;
    EXPECT_GE(bounce.lowest_centre->value, brute.lowest - bounce.lowest_centre->found_to - bend)
        << each.name;
    EXPECT_GE(bounce.greatest_flattening->value, brute.flattest - 1e-13) << each.name;
    EXPECT_LE(bounce.greatest_flattening->value,
              brute.flattest + bounce.greatest_flattening->found_to + bend)
        << each.name;
    EXPECT_NEAR(bounce.lowest_centre_time->value, brute.lowest_time,
                step + bounce.lowest_centre_time->found_to)
        << each.name;
  }
}

// To the bit, for any stops of the run.
TEST(Figures, DoNotDependOnWhenTheRunStops) {
  for (const Case& each : cases()) {
    const Bounce one = figures_of(each.scene).bounce;
    for (const std::int64_t stops : {1, 7, 100}) {
      const Bounce other = figures_of(each.scene, stops).bounce;
      for (const FigureName& name : figure_names) {
        const auto &a = one.*name.figure, &b = other.*name.figure;
        ASSERT_EQ(a.has_value(), b.has_value()) << each.name << " " << name.name;
        if (!a) continue;
        EXPECT_EQ(a->value, b->value) << each.name << " " << name.name << " every " << stops;
        EXPECT_EQ(a->found_to, b->found_to) << each.name << " " << name.name;
      }
    }
  }
}

// Nothing can be looked at again: what is found is within what is said of it.
TEST(Figures, LooksAloneAreWithinWhatTheySay) {
  for (const Case& each : cases()) {
    if (each.scene.walls.size() > 1) continue;  // whose impact it is takes looking again
    const Bounce fine = figures_of(each.scene).bounce;
    const Bounce coarse = figures_of(each.scene, 0, false).bounce;
    for (const auto figure :
         {&Bounce::lowest_centre, &Bounce::greatest_flattening, &Bounce::first_contact}) {
      ASSERT_TRUE((coarse.*figure).has_value()) << each.name;
      EXPECT_NEAR((coarse.*figure)->value, (fine.*figure)->value,
                  (coarse.*figure)->found_to + (fine.*figure)->found_to)
          << each.name;
    }
  }
}

// By a method of order 6 with located contact a run comes near the reference, in all figures.
TEST(Figures, OfARunAreThoseOfTheReference) {
  for (const double beta : {0.0, -1.0}) {
    Scene scene = with(small_scene(0.3), "blanes-moan-6", Contact::located, 2e-4);
    scene.walls[0].alpha = beta == 0.0 ? 0.5 : 1.0;
    scene.walls[0].beta = beta;
    scene.time.end = 0.25;
    const Problem problem = make_problem(scene);
    ContactGauge gauge(problem);
    solve_fixed(
        problem, std::vector<double>{scene.time.end}, {}, [](double, const State&) {}, &gauge);
    const Bounce reference = gauge.result(), run = figures_of(scene).bounce;
    for (const FigureName& name : figure_names) {
      if (name.figure == &Bounce::energy_lost) continue;  // not a gauge's
      const auto &a = run.*name.figure, &b = reference.*name.figure;
      ASSERT_EQ(a.has_value(), b.has_value()) << name.name << " " << beta;
      if (!a) continue;
      // 1e-9: the method's own error at this step, measured 1e-10 at most.
      EXPECT_NEAR(a->value, b->value, a->found_to + b->found_to + 1e-9) << name.name << " " << beta;
    }
  }
}

// A ball between floor and lid: the flight between them is no contact, and each return begins an
// impact of its own.
TEST(Figures, FlightsBetweenWallsAreNoContact) {
  Scene scene = small_scene(0.3);
  scene.time.end = 1.2;
  scene.walls = {Wall{{0.0, 1.0}, 0.0, 1.0, -1.0}, Wall{{0.0, -1.0}, -4.6, 1.0, -1.0}};
  scene.ball.velocity.y = 8.0;
  scene.gravity.y = 0.0;
  scene.law.elasticity = 1e5;  // impacts of some hundredths of a second
  const Bounce bounce = figures_of(with(scene, "leapfrog", Contact::located, 1e-5)).bounce;
  // At least six passes of 0.6 cm at 8 cm/s or less in 1.2 s.
  EXPECT_LT(bounce.contact_time->value, 1.2 - 6 * 0.6 / 8.0);
  EXPECT_GT(bounce.contact_time->value, 0.01);
  ASSERT_TRUE(bounce.restitution);
  EXPECT_LT(bounce.restitution->value, 1.0);
}

TEST(Figures, AStateThatIsNotFiniteEndsThem) {
  const Scene scene = small_scene(0.3);
  const Problem problem = make_problem(scene);
  BounceGauge gauge(problem, scene.time.step, {});
  State state = problem.initial;
  gauge.look(0, state);
  state.vx[20] = std::nan("");
  gauge.look(5, state);
  gauge.look(10, problem.initial);
  EXPECT_EQ(gauge.last_step(), 0);
  EXPECT_TRUE(std::isfinite(gauge.result().lowest_centre->value));
}

}  // namespace
}  // namespace bounce
