// The two rules of contact: what each does to one particle, and that the resolved one is what the
// paper's tends to when the steps become small.
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/model/wall_rule.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

Wall wall_with(Contact contact, double alpha, double beta, Vec2 normal = {0.0, 1.0}) {
  return {.normal = normal, .offset = 0.5, .alpha = alpha, .beta = beta, .contact = contact};
}

// A particle that was 0.1 above the wall at 0.5 and has drifted for 0.25 s to 0.3 below it.
constexpr double drift = 0.25;
const Motion fallen{{3.0, 0.2}, {2.0, -1.6}};

void expect_motion(const Motion& m, Vec2 x, Vec2 v) {
  constexpr double roundings = 1e-15;  // of numbers up to 3, a few of them
  EXPECT_NEAR(m.position.x, x.x, 4 * roundings);
  EXPECT_NEAR(m.position.y, x.y, roundings);
  EXPECT_NEAR(m.velocity.x, v.x, roundings);
  EXPECT_NEAR(m.velocity.y, v.y, roundings);
}

TEST(WallRule, ThePapersMirrors) {
  expect_motion(after_wall(wall_with(Contact::listing, 0.5, -0.25), drift, fallen), {3.0, 0.8},
                {1.0, 0.4});
  expect_motion(after_wall(wall_with(Contact::listing, 0.0, 0.0), drift, fallen), {3.0, 0.8}, {});
}

// It crosses after a quarter of the drift, at x = 2.5 + 0.125.
TEST(WallRule, TheResolvedOneLocatesTheCrossing) {
  expect_motion(after_wall(wall_with(Contact::resolved, 0.0, 0.0), drift, fallen), {2.625, 0.5},
                {});
  expect_motion(after_wall(wall_with(Contact::resolved, 0.5, -0.25), drift, fallen),
                {2.625 + 0.1875, 0.5 + 0.075}, {1.0, 0.4});
  expect_motion(after_wall(wall_with(Contact::resolved, 1.0, 0.0), drift, fallen), {3.0, 0.5},
                {2.0, 0.0});
}

TEST(WallRule, BothAreOneWhereNothingIsLost) {
  const double h = std::sqrt(0.5);
  for (const Vec2 normal : {Vec2{0.0, 1.0}, Vec2{h, h}, Vec2{-0.6, 0.8}}) {
    const Motion behind{{-3.0, 0.2}, {0.3, -1.6}};
    const Motion a = after_wall(wall_with(Contact::listing, 1.0, -1.0, normal), drift, behind);
    const Motion b = after_wall(wall_with(Contact::resolved, 1.0, -1.0, normal), drift, behind);
    EXPECT_EQ(a.position.x, b.position.x);
    EXPECT_EQ(a.position.y, b.position.y);
    EXPECT_EQ(a.velocity.x, b.velocity.x);
    EXPECT_EQ(a.velocity.y, b.velocity.y);
  }
}

// Kicked against the wall from rest on it, along it too, for a thousand steps.
TEST(WallRule, APressedParticleRestsOnlyUnderTheResolvedRule) {
  for (const double alpha : {0.0, 0.5}) {
    for (const auto contact : {Contact::listing, Contact::resolved}) {
      const Wall wall = wall_with(contact, alpha, 0.0);
      Motion m{{3.0, 0.5}, {}};
      constexpr double dt = 1e-6;
      for (int step = 0; step < 1000; ++step) {
        m.velocity.x += dt * 700.0;
        m.velocity.y -= dt * 300.0;
        m.position.x += dt * m.velocity.x;
        m.position.y += dt * m.velocity.y;
        if (!(m.position.y > wall.offset)) m = after_wall(wall, dt, m);
      }
      // The listing's rule lets it creep by about a dt^2 each step; half an ULP of 3 a step is what
      // rounding may do.
      if (contact == Contact::resolved) {
        EXPECT_NEAR(m.position.x, 3.0, 1000 * 2.2e-16);
        EXPECT_EQ(m.position.y, 0.5);
        EXPECT_EQ(m.velocity.x, 0.0);
      } else {
        EXPECT_GT(m.position.x, 3.0 + 300 * 700.0 * dt * dt);
      }
    }
  }
}

TEST(WallRule, APulledParticleIsFree) {
  const Wall wall = wall_with(Contact::resolved, 0.0, 0.0);
  const Motion lifted{{3.0, 0.5 + 1e-12}, {0.0, 1e-6}};
  EXPECT_GT(wall_distance(wall, lifted.position.x, lifted.position.y), 0.0);  // never gets there
  // Behind the wall for another reason (a corner, a start), but on its way out: put onto it.
  expect_motion(after_wall(wall, drift, {{3.0, 0.2}, {2.0, 1.6}}), {3.0, 0.5}, {});
  expect_motion(after_wall(wall, drift, {{3.0, 0.2}, {0.0, 0.0}}), {3.0, 0.5}, {});
}

// The height of the ball's centre at t = 15 in Example 1.
double height(const std::string& method, double step, Contact contact) {
  Scene scene;
  scene.law.elasticity = 1000.0;
  scene.constants = Constants::double_precision;
  scene.walls = {Wall{.contact = contact}};
  scene.time.method = method;
  scene.time.step = step;
  const Problem problem = make_problem(scene);
  const auto stepper = make_stepper(problem, {"auto", "auto", 1});
  stepper->advance(scene.steps_until(15.0));
  const State state = stepper->state();
  double sum = 0.0;
  for (const double y : state.y) sum += y;
  return sum / static_cast<double>(state.size());
}

// The paper's rule still moves by 1e-3 cm between 1e-5 and 1e-6 s. The resolved one has converged:
// leapfrog's error on the ball's vibrations is (omega dt)^2 / 24 of their phase, at 1e-4 s of the
// fastest (1305 1/s at E = 1000) 7e-4; what the centre's height keeps of it is far less. The bound
// is a tenth of the smallest of the differences that the paper's rule makes.
TEST(WallRule, TheResolvedOneConverges) {
  const double finest = height("leapfrog", 1e-5, Contact::resolved);
  EXPECT_NEAR(height("leapfrog", 2e-5, Contact::resolved), finest, 1e-5);
  EXPECT_NEAR(height("leapfrog", 1e-4, Contact::resolved), finest, 1e-4);
  EXPECT_NEAR(height("leapfrog", 1e-3, Contact::resolved), finest, 1e-4);
  // Stages that step back must not hold to the wall what is pulled off it.
  for (const Method& method : methods()) {
    EXPECT_NEAR(height(std::string(method.name), 2e-4, Contact::resolved), finest, 1e-4)
        << method.name;
  }
  EXPECT_GT(std::abs(height("leapfrog", 1e-4, Contact::listing) - finest), 1e-3);
  EXPECT_GT(std::abs(height("listing", 1e-5, Contact::listing) - finest), 1e-3);
}

}  // namespace
}  // namespace bounce
