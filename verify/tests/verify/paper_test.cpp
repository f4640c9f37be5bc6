// What the paper says of each of its examples (section 3), as claims on the built-in scenes run at
// full length with the paper's time step and the plan's own choice of kernel.
//
// A claim is a predicate, so that each can also be denied of an example of which the paper says the
// opposite: bends() of Example 1, not of Example 2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "driver/scene/scene_file.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/figures/bounce_gauge.hpp"
#include "verify/figures/shape.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

constexpr double sample_every = 0.05;  // s; the shortest contact lasts 0.8 s
constexpr double outer_radius = 7.0;   // cm

struct Moment {
  std::int64_t step = 0;
  double time = 0.0;  // s, in the nominal step
  State state;
  Sample sample;
  Shape shape;
};

struct ExampleRun {
  Problem problem;
  std::vector<Moment> moments;
  Bounce bounce;

  [[nodiscard]] const Moment& start() const { return moments.front(); }
  [[nodiscard]] const Moment& end() const { return moments.back(); }
  // The sample at t (s); a test ends here if there is none.
  [[nodiscard]] const Moment& at(double t) const {
    const auto index = static_cast<std::size_t>(std::llround(t / sample_every));
    return moments.at(index);
  }
};

// Also sees to it that the watch has nothing to say against a run that the paper shows.
ExampleRun run_example(int number, const std::string& change = {}) {
  SceneFile file = SceneFile::find("example-" + std::to_string(number));
  if (!change.empty()) file.set(change);
  const Scene scene = file.scene();
  ExampleRun run{.problem = make_problem(scene), .moments = {}, .bounce = {}};
  const Plan plan = make_plan(run.problem, {});
  const auto stepper = plan.make_stepper();
  const std::int64_t last = scene.steps_until(scene.time.end);
  const std::int64_t every = scene.steps_until(sample_every);
  Watch watch(run.problem, run.problem.initial);
  BounceGauge gauge(run.problem, scene.time.step, remake(plan));
  for (;;) {
    gauge.look(*stepper);
    Moment now{
        .step = stepper->step(), .time = 0.0, .state = stepper->state(), .sample = {}, .shape = {}};
    now.time = static_cast<double>(now.step) * scene.time.step;
    now.sample = measure(run.problem, now.state);
    now.shape = measure_shape(now.state, 3);
    if (const auto trouble = watch.check(now.state, now.sample)) {
      ADD_FAILURE() << "t = " << now.time << ": " << trouble->what;
      return run;
    }
    watch.accept(now.sample);
    run.moments.push_back(std::move(now));
    if (stepper->step() >= last) break;
    stepper->advance(std::min(every, last - stepper->step()));
  }
  run.bounce = gauge.result();
  return run;
}

struct Span {
  double from = 0.0;  // s
  double to = std::numeric_limits<double>::infinity();
};

// Greatest value over the samples of a span; NaN if any is, or if there is no sample.
double greatest(const ExampleRun& run, const std::function<double(const Moment&)>& value,
                Span span = {}) {
  double found = std::numeric_limits<double>::quiet_NaN();
  bool any = false;
  for (const Moment& moment : run.moments) {
    if (moment.time < span.from || moment.time > span.to) continue;
    const double here = value(moment);
    if (std::isnan(here)) return here;
    if (!any || here > found) found = here;
    any = true;
  }
  return found;
}

double least(const ExampleRun& run, const std::function<double(const Moment&)>& value,
             Span span = {}) {
  return -greatest(
      run, [&](const Moment& moment) { return -value(moment); }, span);
}

double flattening(const Moment& moment) { return moment.shape.flattening; }
double enclosed(const Moment& moment) { return moment.shape.enclosed; }
double spin(const Moment& moment) { return moment.shape.spin; }
double height(const Moment& moment) { return moment.sample.centre.y; }

// Greatest |energy - energy at the start|, erg.
double energy_change(const ExampleRun& run) {
  return greatest(run, [&](const Moment& moment) {
    return std::abs(moment.sample.total() - run.start().sample.total());
  });
}

// Greatest R/R0 of any bond.
double longest_bond(const Problem& problem, const State& s) {
  double longest = 0.0;
  const BondList& bonds = problem.bonds;
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (auto e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      const auto j = static_cast<std::size_t>(bonds.neighbour[entry]);
      const double rest = problem.classes[bonds.bond_class[entry]].rest;
      const double ratio = std::hypot(s.x[i] - s.x[j], s.y[i] - s.y[j]) / rest;
      if (!(ratio <= longest)) longest = ratio;
      if (std::isnan(longest)) return longest;
    }
  }
  return longest;
}

AssertionResult says(bool holds, const std::string& text) {
  return (holds ? AssertionSuccess() : AssertionFailure()) << text;
}

// "Extensive bending" (Examples 1 and 4) and "circular shape at all times" (Example 2) are told
// apart by the greatest flattening of the outer ring. Runs give 0.115 and 0.138 against 0.027; the
// two bounds leave a gap of a factor 2 between them that no example may stand in. A figure 4 %
// flatter than a circle looks like one; 8 % is what a reader sees.
AssertionResult bends(const ExampleRun& run) {
  const double most = greatest(run, flattening);
  return says(most >= 0.08, "greatest flattening " + std::to_string(most));
}
AssertionResult keeps_round(const ExampleRun& run) {
  const double most = greatest(run, flattening);
  return says(most <= 0.04, "greatest flattening " + std::to_string(most));
}

// The ball comes down on a wall, its centre rises again, and it leaves the wall for good: nothing
// touches in the last second. The centre regains at least a quarter of its fall: a falling ball
// regains 68 % or more; on the incline (Example 7), where half of the fall's energy goes into
// motion along the axis, 41 %.
AssertionResult bounces(const ExampleRun& run) {
  const Bounce& b = run.bounce;
  const double fall = height(run.start()) - b.lowest_centre->value;
  const double rise = b.rebound_height->value - b.lowest_centre->value;
  const bool left = b.last_contact && b.last_contact->value <= run.end().time - 1.0 &&
                    run.end().sample.on_wall == 0;
  return says(left && fall > 0.0 && rise >= 0.25 * fall,
              "fall " + std::to_string(fall) + ", rise " + std::to_string(rise) +
                  ", last contact " +
                  std::to_string(b.last_contact ? b.last_contact->value : -1.0));
}

// No bond has passed sqrt(5/3) R0, where the law's attraction is greatest and beyond which a bond
// yields to a constant pull; and the ball is not folded: a bent ball of Examples 1 and 4 still
// encloses 97 % of its area, 90 % allows for more bending and for no fold.
AssertionResult in_one_piece(const ExampleRun& run) {
  const double longest =
      greatest(run, [&](const Moment& moment) { return longest_bond(run.problem, moment.state); });
  const double area = least(run, enclosed) / enclosed(run.start());
  return says(longest < std::sqrt(5.0 / 3.0) && area > 0.9,
              "longest bond R/R0 = " + std::to_string(longest) + ", enclosed area down to " +
                  std::to_string(area) + " of the start's");
}

// Time at which a rigid ball would touch the axis, s.
double touch_down(const ExampleRun& run) {
  return std::sqrt(2.0 * run.start().sample.lowest / -run.problem.gravity.y);
}

// Until a wall is touched the centre of mass follows the listing's scheme exactly: after n steps
// x = x0 + n dt vx, y = y0 - g dt^2 n (n+1)/2. What is left is rounding: 8e6 steps of half a last
// digit of 10 cm (9e-16) with random signs are 1.5e-12 cm a particle, less in their mean; measured
// 2e-12. The parabola of exact time, n^2 in place of n (n+1), is 4e-7 cm away.
void expect_free_fall(const ExampleRun& run) {
  constexpr double rounding = 1e-11;
  const auto mass = static_cast<double>(run.problem.initial.size());
  const double until = 0.99 * touch_down(run);
  const double dt = run.problem.step;
  int looks = 0;
  for (const Moment& moment : run.moments) {
    if (moment.time > until) break;
    const auto n = static_cast<double>(moment.step);
    const double speed = run.start().sample.momentum.x / mass;
    const double fall = -run.problem.gravity.y * dt * dt * n * (n + 1.0) / 2.0;
    ASSERT_NEAR(moment.sample.centre.x, run.start().sample.centre.x + n * dt * speed,
                // The distance travelled has digits of its own.
                rounding + 1e-13 * n * dt * speed);
    ASSERT_NEAR(moment.sample.centre.y, height(run.start()) - fall, rounding) << moment.time;
    ASSERT_LT(moment.shape.flattening, 1e-6);  // nothing bends it; measured 5e-14
    ++looks;
  }
  EXPECT_GE(looks, 75);  // 4 s or more
}

// Greatest distance by which a particle misses the mirror image of its partner across x = 0, cm.
double asymmetry(const Moment& moment) {
  const State& s = moment.state;
  double most = 0.0;
  for (std::size_t ring = 0; ring < 3; ++ring) {
    const std::size_t opposite = ring == 1 ? 179 : 180;  // the second ring is turned by half a step
    for (std::size_t i = 0; i < 120; ++i) {
      const std::size_t a = 120 * ring + i;
      const std::size_t b = 120 * ring + (opposite - i) % 120;
      const double miss = std::max(std::abs(s.x[a] + s.x[b]), std::abs(s.y[a] - s.y[b]));
      if (!(miss <= most)) most = miss;
      if (std::isnan(most)) return most;
    }
  }
  return most;
}

TEST(Paper, Example1BendsExtensivelyAndBounces) {
  const ExampleRun run = run_example(1);
  expect_free_fall(run);
  // The ball starts as its own mirror image to the last digit, but the listing sums forces in an
  // order that is not: until it lands, mirror images drift apart by rounding alone, like the centre
  // of mass above but a particle at a time; measured 2.4e-12 cm.
  EXPECT_EQ(asymmetry(run.start()), 0.0);
  EXPECT_LT(greatest(run, asymmetry, {0.0, 0.99 * touch_down(run)}), 1e-11);
  EXPECT_TRUE(bends(run));
  EXPECT_FALSE(keeps_round(run));
  EXPECT_TRUE(bounces(run));
  EXPECT_TRUE(in_one_piece(run));
  // Figures 5(d) and 6, t = 9: the lower side is flat and its particles are pressed together. A
  // round ball lies on one to three particles; seven do here, and 7 % flattening was measured.
  const Moment& pressed = run.at(9.0);
  EXPECT_GE(flattening(pressed), 0.05);
  EXPECT_GE(pressed.sample.on_wall, 5);
  EXPECT_LE(pressed.sample.smallest_ratio, 0.985);  // measured 0.976; 0.9996 at the start
  const auto tightest = static_cast<std::size_t>(pressed.sample.ratio_first);
  EXPECT_LE(pressed.state.y[tightest], 1.5);  // in the lowest tenth of the ball
  // Figure 5(f): back in shape at 15 s; measured 0.002.
  EXPECT_LE(flattening(run.at(15.0)), 0.02);
}

TEST(Paper, Example2KeepsItsCircularShapeAndBounces) {
  const ExampleRun run = run_example(2);
  expect_free_fall(run);
  EXPECT_TRUE(keeps_round(run));
  EXPECT_FALSE(bends(run));
  EXPECT_TRUE(bounces(run));
  EXPECT_TRUE(in_one_piece(run));
}

// The paper shows 0, 3 and 6 s; the run goes on to 9 s, to see that the ball stays down.
TEST(Paper, Example3CollapsesOntoTheAxis) {
  const ExampleRun run = run_example(3, "time.end=9");
  expect_free_fall(run);
  EXPECT_FALSE(bounces(run));
  EXPECT_FALSE(in_one_piece(run));
  // At 6 s a ball that had kept its shape would have its centre at 7 cm and 78.5 cm^2 inside; half
  // and a quarter of that are no ball any more. Measured 2.1 cm and 10.4 cm^2.
  const Moment& fallen = run.at(6.0);
  EXPECT_LT(height(fallen), 0.5 * outer_radius);
  EXPECT_LT(enclosed(fallen), 0.25 * enclosed(run.start()));
  // From then on it lies folded through itself (its inside encloses less than nothing) at the axis.
  // How it lies is a matter of rounding, which differs between kernels; that it does is not.
  EXPECT_LT(greatest(run, enclosed, {6.5, 9.0}), 0.0);
  EXPECT_LT(greatest(run, height, {6.0, 9.0}), 0.5 * outer_radius);
}

// "Entirely similar to that in Example 1, and unlike that in Example 2."
TEST(Paper, Example4BendsExtensivelyAndBounces) {
  const ExampleRun run = run_example(4);
  expect_free_fall(run);
  EXPECT_TRUE(bends(run));
  EXPECT_FALSE(keeps_round(run));
  EXPECT_TRUE(bounces(run));
  EXPECT_TRUE(in_one_piece(run));
}

double forward_speed(const ExampleRun& run, const Moment& moment) {
  return moment.sample.momentum.x / static_cast<double>(run.problem.initial.size());
}

TEST(Paper, Example5IsForcedIntoClockwiseRotation) {
  const ExampleRun run = run_example(5);
  expect_free_fall(run);
  EXPECT_TRUE(bounces(run));
  EXPECT_TRUE(in_one_piece(run));
  // Irregular at the collision, t = 8: measured 0.038, against 0.007 in Examples 2 and 6.
  EXPECT_GE(flattening(run.at(8.0)), 0.02);
  // Rotation: none before, rounding of 4 cm/s x 60 cm a particle apart (measured 1e-14 rad/s);
  // afterwards more than 0.1 rad/s clockwise, or a seventh of a turn in the 9 s shown. A ball that
  // rolls at its speed turns at 0.34 rad/s; measured 0.32.
  EXPECT_LT(greatest(run, [](const Moment& m) { return std::abs(spin(m)); },
                     {0.0, 0.99 * touch_down(run)}),
            1e-10);
  const Span after{run.bounce.last_contact.value().value, run.end().time};
  EXPECT_LT(greatest(run, spin, after), -0.1);
  // "Its total horizontal speed decreases": from 4 to 2.4 cm/s measured; at least a quarter goes.
  EXPECT_LT(greatest(
                run, [&](const Moment& m) { return forward_speed(run, m); }, after),
            3.0);
  EXPECT_GT(forward_speed(run, run.end()), 0.0);
}

// Energy that an elastic, frictionless wall may seem to give or take, erg: the error of a method of
// first order. Measured 0.0052 (Example 6) and 0.0035 (Example 7); a run with half the time step
// has half of it. The wall of Example 2 takes 0.6 erg from the same ball, that of Example 5 140.
constexpr double integrator_error = 0.02;

// A spin (rad/s) that turns the ball by half a degree in the 10 s after the impact. Rounding makes
// mirror images differ and the impact multiplies that: measured 1.4e-6 (Example 6) and 1.3e-4
// (Example 7); friction gives 0.3 (Example 5).
constexpr double no_spin = 1e-3;

TEST(Paper, Example6NeverRotatesNorLosesHorizontalSpeed) {
  const ExampleRun run = run_example(6);
  expect_free_fall(run);
  EXPECT_TRUE(bounces(run));
  EXPECT_TRUE(keeps_round(run));
  EXPECT_TRUE(in_one_piece(run));
  // Rounding alone: 18e6 steps of half a last digit of 4 cm/s (4e-16) with random signs, 360
  // particles: 3e-11 of 1440. Measured 4e-11.
  const double start = run.start().sample.momentum.x;
  EXPECT_EQ(start, 1440.0);
  EXPECT_LT(greatest(run, [&](const Moment& m) { return std::abs(m.sample.momentum.x - start); }),
            3e-10);
  EXPECT_LT(greatest(run, [](const Moment& m) { return std::abs(spin(m)); }), no_spin);
  EXPECT_LT(energy_change(run), integrator_error);
}

TEST(Paper, Example7SlidesDownTheInclineAndBouncesOffTheAxis) {
  const ExampleRun run = run_example(7);
  EXPECT_TRUE(bounces(run));
  EXPECT_TRUE(keeps_round(run));
  EXPECT_TRUE(in_one_piece(run));
  // On a frictionless 45 degree incline half of g pulls across and half down, until the ball meets
  // the axis. It is springy and hops a little: measured 0.007 cm off, a thousandth of its radius.
  const double g = -run.problem.gravity.y;
  const double landing = std::sqrt(2.0 * (height(run.start()) - outer_radius) / (0.5 * g));
  const auto off_the_slide = [&](const Moment& m) {
    const double way = 0.25 * g * m.time * m.time;
    return std::max(std::abs(m.sample.centre.x - run.start().sample.centre.x - way),
                    std::abs(height(m) - height(run.start()) + way));
  };
  EXPECT_LT(greatest(run, off_the_slide, {0.0, 0.99 * landing}), 0.02);
  // The axis takes nothing of the speed along it: what the slide gave (0.542 cm/s), the ball keeps.
  EXPECT_GT(least(run, [&](const Moment& m) { return forward_speed(run, m); },
                  {landing + 1.0, run.end().time}),
            0.99 * 0.5 * g * landing);
  // The paper says "roll", but nothing can turn the ball.
  EXPECT_LT(greatest(run, [](const Moment& m) { return std::abs(spin(m)); }), no_spin);
  EXPECT_LT(energy_change(run), integrator_error);
}

}  // namespace
}  // namespace bounce
