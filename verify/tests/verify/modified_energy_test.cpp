// The modified energy: its terms, and that the energy swings less with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/verify/ledger_runs.hpp"
#include "verify/vibrations/stability_limit.hpp"
#include "verify/watch/inspection.hpp"

namespace bounce {
namespace {

TEST(ModifiedEnergy, IsThatOfTheLiterature) {
  // Hairer, Lubich, Wanner, Geometric Numerical Integration, IX: symplectic Euler and
  // Stoermer-Verlet.
  const ModifiedEnergy euler = modified_energy(*find_method("listing"));
  EXPECT_DOUBLE_EQ(euler.first, -1.0 / 2);
  EXPECT_DOUBLE_EQ(euler.stiffness, 1.0 / 12);
  EXPECT_DOUBLE_EQ(euler.force, 1.0 / 12);
  const ModifiedEnergy verlet = modified_energy(*find_method("leapfrog"));
  EXPECT_NEAR(verlet.first, 0.0, 1e-16);
  EXPECT_DOUBLE_EQ(verlet.stiffness, 1.0 / 12);
  EXPECT_DOUBLE_EQ(verlet.force, -1.0 / 24);
}

// Orders of three and more leave nothing of these terms.
TEST(ModifiedEnergy, IsTheEnergyForMethodsOfHigherOrder) {
  for (const Method& method : methods()) {
    if (method.order < 3) continue;
    const ModifiedEnergy z = modified_energy(method);
    // Coefficients of 15 digits, products of three in some ten stages.
    EXPECT_NEAR(z.first, 0.0, 1e-14) << method.name;
    EXPECT_NEAR(z.stiffness, 0.0, 1e-14) << method.name;
    EXPECT_NEAR(z.force, 0.0, 1e-14) << method.name;
  }
}

// The greatest swing of the energy, and what is left of it, in a ball that rings, with steps of
// some omega dt.
struct Swing {
  double whole = 0.0, left = 0.0;
  double allowed = 0.0;  // by the ledger for terms left out
};
Swing swing_of(const Method& method, double angle) {
  Scene scene = paper_scene(2);
  scene.walls.clear();
  scene.time.method = method.name;
  scene.time.step = angle / 5221.0;
  Problem problem = make_problem(scene);
  for (std::size_t i = 0; i < problem.initial.size(); ++i) {
    problem.initial.vx[i] = std::sin(4.0 * problem.initial.x[i]);
  }
  const auto stepper = plan_of(scene, problem, "csr").make_stepper();
  const Sample start = measure(problem, problem.initial);
  const double first = start.total() + inspect(problem, problem.initial, start).swing;
  Swing swing;
  const auto every = static_cast<std::int64_t>(std::ceil(1.4 / angle));
  for (int sample = 0; sample < 200; ++sample) {
    stepper->advance(every);
    const State state = stepper->state();
    const Sample now = measure(problem, state);
    const Inspection here = inspect(problem, state, now);
    swing.whole = std::max(swing.whole, std::abs(now.total() - start.total()));
    swing.left = std::max(swing.left, std::abs(now.total() + here.swing - first));
    swing.allowed = left_out(problem, here);
  }
  return swing;
}

// What is left of the swing falls as the third power of the step or faster, where the energy's own
// falls as the first (listing) or the second (leapfrog); of a method of higher order it is the
// energy's own and falls as its order says. 0.5: samples do not meet the greatest swing. omega dt:
// where the sixth order is above rounding, 1e-8 of 2.6e7 erg.
TEST(ModifiedEnergy, SwingsLessByTwoOrders) {
  for (const Method& method : methods()) {
    const double angle = method.order > 2 ? 0.45 * stability_limit(method) : 0.4;
    const Swing coarse = swing_of(method, angle), fine = swing_of(method, 0.5 * angle);
    const int order = std::max(3, method.order);
    EXPECT_GT(std::log2(coarse.left / fine.left), order - 0.5)
        << method.name << " " << coarse.left << " " << fine.left;
    if (method.order < 3) {
      EXPECT_LT(coarse.left, 0.1 * coarse.whole) << method.name;
    }
  }
}

// The ledgers close up to near the edge: the terms that they leave out have factors below 1. 1e-6:
// rounding of 2.6e7 erg.
TEST(ModifiedEnergy, LeavesOutLessThanTheLedgerAllows) {
  for (const Method& method : methods()) {
    for (const double part : {0.1, 0.5, 0.9}) {
      const Swing swing = swing_of(method, part * stability_limit(method));
      EXPECT_LT(swing.left, swing.allowed + 1e-6) << method.name << " " << part;
    }
  }
}

}  // namespace
}  // namespace bounce
