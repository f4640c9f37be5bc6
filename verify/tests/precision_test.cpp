// time.precision: how near to exact arithmetic each precision is, same bits, contact, refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/ensemble.hpp"
#include "kernels/stepping/method.hpp"
#include "kernels/stepping/plan.hpp"

namespace bounce {
namespace {

constexpr double half_ulp = 0x1p-24;  // of a float, as a part of it

Scene flying(Precision precision) {
  Scene scene;
  scene.ball.velocity = {0.5, -2.0};
  scene.time.precision = precision;
  return scene;
}

// Touches the floor after 2000 steps.
Scene touching(Precision precision) {
  Scene scene = flying(precision);
  scene.ball.centre.y = 7.004;
  scene.walls = {Wall{}};
  return scene;
}

std::unique_ptr<Stepper> stepper_of(const Problem& problem, const std::string& vector = "auto",
                                    const std::string& kernel = "ring") {
  return make_stepper(problem, make_plan(problem, {kernel, vector, 1}));
}

Snapshot after(const Scene& scene, std::int64_t steps, const std::string& vector = "auto") {
  const auto stepper = stepper_of(make_problem(scene), vector);
  stepper->advance(steps);
  return stepper->save();
}

// The listing's scheme in 64-bit significands: 2000 times finer than double.
struct Fine {
  std::vector<long double> x, y, vx, vy;
};
Fine stepped_finely(const Problem& problem, int steps) {
  const State& start = problem.initial;
  Fine s{{start.x.begin(), start.x.end()},
         {start.y.begin(), start.y.end()},
         {start.vx.begin(), start.vx.end()},
         {start.vy.begin(), start.vy.end()}};
  const long double dt = problem.step;
  for (int step = 0; step < steps; ++step) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      long double ax = problem.gravity.x, ay = problem.gravity.y;
      problem.bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
        const long double dx = s.x[i] - s.x[j], dy = s.y[i] - s.y[j];
        const long double u = 1 / (dx * dx + dy * dy);
        const long double f =
            u * u * (problem.classes[c].repulsion * u - problem.classes[c].attraction);
        ax += f * dx;
        ay += f * dy;
      });
      s.vx[i] += dt * ax;
      s.vy[i] += dt * ay;
    }
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      s.x[i] += dt * s.vx[i];
      s.y[i] += dt * s.vy[i];
    }
  }
  return s;
}

struct Error {
  double largest = 0.0;  // of a particle's position, cm
  double mean = 0.0;     // of the centre of mass, cm
};
Error error_of(const Snapshot& got, const Fine& fine) {
  Error error;
  long double sum_x = 0, sum_y = 0;
  // In single precision the state holds the low parts already.
  const bool add_low = got.low.size() > 0 && std::abs(got.low.x[0]) < 1e-12;
  for (std::size_t i = 0; i < fine.x.size(); ++i) {
    const long double dx = got.state.x[i] - fine.x[i] + (add_low ? got.low.x[i] : 0.0);
    const long double dy = got.state.y[i] - fine.y[i] + (add_low ? got.low.y[i] : 0.0);
    const auto d = static_cast<double>(std::hypot(dx, dy));
    if (!(d <= error.largest)) error.largest = d;
    sum_x += dx;
    sum_y += dy;
  }
  const auto n = static_cast<long double>(fine.x.size());
  error.mean = static_cast<double>(std::hypot(sum_x, sum_y) / n);
  return error;
}

double largest_difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]);
    if (!(d <= largest)) largest = d;
  }
  return largest;
}

std::string refusal_of(const Scene& scene, const PlanRequest& request) {
  try {
    static_cast<void>(make_plan(make_problem(scene), request));
  } catch (const PlanError& error) {
    return error.what();
  }
  return {};
}

constexpr int flight_steps = 20000;
const Fine& flight() {
  static const Fine fine =
      stepped_finely(make_problem(flying(Precision::double_precision)), flight_steps);
  return fine;
}

// Plain double rounds a position of 8 to 16 cm by ULP/sqrt(12) = 5e-16 cm a step, a random walk;
// the largest of 360 walks is above one such deviation. With low parts what is left is the rounding
// of the force, as if a bond were off by some 3 half ULP of its 0.26 to 1 cm, not of 10 cm: ten
// times less at least; and it drives a vibration of omega dt = 5e-3, which turns on before it adds
// up: another 200 / 3 times. 300 is half of that.
TEST(Precision, LowPartsTakeTheRoundingOfPositionsAway) {
  const Error plain = error_of(after(flying(Precision::double_precision), flight_steps), flight());
  const Error low = error_of(after(flying(Precision::compensated), flight_steps), flight());
  EXPECT_GE(plain.largest, std::sqrt(flight_steps) * 5e-16);
  EXPECT_LE(300.0 * low.largest, plain.largest);
  EXPECT_GT(low.largest, 0.0);
}

// H and G are rounded by half an ULP each, so R0 by one half: a ball of 7 cm swings about a size
// that is off by 7 cm times that, and by twice that in all. R^2 and the law round some four times,
// other ways for each bond: as much again.
TEST(Precision, SingleIsOffByTheRoundingOfItsForces) {
  const Error single = error_of(after(flying(Precision::single_precision), flight_steps), flight());
  EXPECT_LE(single.largest, 4.0 * 7.0 * half_ulp);
  // Bonds push both ends alike, so the centre is off only by the rounding of dt, v dt and g dt. It
  // travels 2.06 cm/s for 0.02 s. (A velocity without low part loses g dt, 1e-7, altogether.)
  EXPECT_LE(single.mean, 3.0 * half_ulp * 2.1 * 1e-6 * flight_steps);
  EXPECT_GT(single.largest, 0.0);
}

class EachPrecision : public testing::TestWithParam<Precision> {};

TEST_P(EachPrecision, HasTheSameBitsForAllVectors) {
  const State first = after(touching(GetParam()), 5000, "avx2").state;
  for (const VectorTarget target : available_vectors()) {
    const State other = after(touching(GetParam()), 5000, std::string(name_of(target))).state;
    EXPECT_EQ(state_hash(first), state_hash(other)) << name_of(target);
  }
}

// 28 columns are dealt to 4 lanes, also where there are 8.
TEST(Precision, TakesColumnsThatOnlyFourLanesDivide) {
  Scene scene = flying(Precision::compensated);
  scene.ball.per_ring = 28;
  scene.law.rest = Rest::geometry;
  const State first = after(scene, 1000, "avx2").state;
  scene.time.precision = Precision::double_precision;
  EXPECT_LE(largest_difference(first, after(scene, 1000, "avx2").state), 1000 * 3.6e-15);
  scene.time.precision = Precision::compensated;
  for (const VectorTarget target : available_vectors()) {
    const State other = after(scene, 1000, std::string(name_of(target))).state;
    EXPECT_EQ(state_hash(first), state_hash(other)) << name_of(target);
  }
}

TEST_P(EachPrecision, GoesOnFromASnapshotWithTheSameBits) {
  for (const char* method : {"listing", "leapfrog"}) {
    Scene scene = touching(GetParam());
    scene.time.method = method;
    const Problem problem = make_problem(scene);
    const auto whole = stepper_of(problem), first = stepper_of(problem),
               second = stepper_of(problem);
    whole->advance(6000);
    first->advance(3001);
    second->restore(first->save());
    second->advance(2999);
    const Snapshot a = whole->save(), b = second->save();
    EXPECT_EQ(state_hash(a.state), state_hash(b.state)) << method;
    EXPECT_EQ(state_hash(a.low), state_hash(b.low)) << method;
    EXPECT_GT(a.low.size(), 0U);
  }
}

TEST_P(EachPrecision, KeepsANanWhereItIs) {
  Problem problem = make_problem(touching(GetParam()));
  problem.initial.y[0] = std::numeric_limits<double>::quiet_NaN();
  const auto stepper = stepper_of(problem);
  stepper->advance(3);
  const State state = stepper->state();
  EXPECT_TRUE(std::isnan(state.y[0]));
  EXPECT_TRUE(std::isfinite(state.y[60]));  // across the ring; a step reaches one bond further
}

INSTANTIATE_TEST_SUITE_P(All, EachPrecision,
                         testing::Values(Precision::compensated, Precision::single_precision),
                         [](const auto& of) {
                           return of.param == Precision::compensated ? "Compensated" : "Single";
                         });

// Beside plain double, after some thousand steps on walls. Roundings part by an ULP a step and
// position, 3.6e-15 cm; a wall at an angle adds one a contact.
TEST(Precision, CompensatedMeetsWallsAsDoubleDoes) {
  const double h = std::sqrt(0.5);
  for (const Contact contact : {Contact::listing, Contact::resolved}) {
    for (const bool wedge : {false, true}) {
      const auto scene_of = [&](Precision precision) {
        Scene scene = touching(precision);
        if (wedge)
          scene.walls = {Wall{{h, h}, -2.051, 0.3, -0.7}, Wall{{0.0, 1.0}, 0.0, 1.0, -1.0}};
        for (Wall& wall : scene.walls) wall.contact = contact;
        return scene;
      };
      constexpr int steps = 8000;
      const State plain = after(scene_of(Precision::double_precision), steps).state;
      const Scene scene = scene_of(Precision::compensated);
      Scene open = scene;
      open.walls.clear();
      const State low = after(scene, steps).state;
      EXPECT_LE(largest_difference(low, plain), 2.0 * steps * 3.6e-15) << wedge;
      EXPECT_GT(largest_difference(low, after(open, steps).state), 1e-4) << "it met no wall";
    }
  }
}

// The floor turns high and low parts exactly; the moment of a contact may be another by one step,
// which moves a particle by v dt = 2e-6 cm.
TEST(Precision, SingleMeetsAFloorAsDoubleDoes) {
  const State plain = after(touching(Precision::double_precision), 8000).state;
  const State single = after(touching(Precision::single_precision), 8000).state;
  EXPECT_LE(largest_difference(single, plain), 4.0 * 7.0 * half_ulp + 2.1e-6);
}

TEST(Precision, OnlyRingHasOthersThanDouble) {
  for (const Precision precision : {Precision::compensated, Precision::single_precision}) {
    EXPECT_EQ(make_plan(make_problem(flying(precision))).kernel, "ring");
    for (const char* kernel : {"mirror", "rings", "csr", "strict"}) {
      EXPECT_NE(refusal_of(flying(precision), {kernel, "auto", 1}).find("double precision only"),
                std::string::npos)
          << kernel;
    }
    EXPECT_NE(refusal_of(flying(precision), {"ring", "auto", 2}).find("one thread"),
              std::string::npos);
    const std::vector<Problem> one{make_problem(flying(precision))};
    EXPECT_THROW(Ensemble{one}, PlanError);
    Scene other_law = flying(precision);
    other_law.law.p = 7.0;
    other_law.law.q = 13.0;
    EXPECT_NE(refusal_of(other_law, {"ring", "auto", 1}).find("(3, 5) only"), std::string::npos);
  }
}

TEST(Precision, SingleRefusesWallsThatItCannotMeet) {
  Scene scene = touching(Precision::single_precision);
  scene.walls[0].contact = Contact::resolved;
  EXPECT_NE(refusal_of(scene, {}).find("at rest on a wall"), std::string::npos);
  scene = touching(Precision::single_precision);
  scene.walls[0].normal = {1.0, 0.0};
  scene.walls[0].offset = -20.0;
  EXPECT_NE(refusal_of(scene, {}).find("one floor"), std::string::npos);
}

}  // namespace
}  // namespace bounce
