// The kernels of rings: the shape they look for, their ways through a ball, the half of a symmetric
// ball, an annulus of many rings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "kernels/model/bonds.hpp"
#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "kernels/rings/mirror_symmetry.hpp"
#include "kernels/rings/ring_forms.hpp"
#include "kernels/rings/ring_shape.hpp"
#include "kernels/stepping/threads.hpp"
#include "verify/tests/kernels/kernel_scenes.hpp"
#include "verify/tests/kernels/plain_steps.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

TEST(RingShape, IsFoundWhateverTheOrderAndNotAssumed) {
  const BondList bonds = ring_bonds(3, 120);
  const auto shape = find_rings(bonds);
  ASSERT_TRUE(shape.has_value());
  EXPECT_EQ(shape->rings, 3);
  EXPECT_EQ(shape->per_ring, 120);
  EXPECT_EQ(shape->along, (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(shape->same, (std::vector<int>{1, 3}));
  EXPECT_EQ(shape->diagonal, (std::vector<int>{1, 3}));
  for (const int rings : {1, 2, 3, 4}) {
    const auto known = find_rings(Neighbours::of_rings(rings, 17));
    const auto found = find_rings(ring_bonds(rings, 17));
    ASSERT_TRUE(known && found);
    EXPECT_EQ(known->rings, found->rings);
    EXPECT_EQ(known->per_ring, found->per_ring);
    EXPECT_EQ(known->along, found->along);
    EXPECT_EQ(known->same, found->same);
    EXPECT_EQ(known->diagonal, found->diagonal);
  }
  EXPECT_FALSE(find_rings(Neighbours::of_rings(5, 17)));
  BondList one_class_off = bonds;
  one_class_off.bond_class[700] ^= 1;
  EXPECT_FALSE(find_rings(one_class_off).has_value());
  BondList one_bond_off = bonds;
  one_bond_off.neighbour[700] = (one_bond_off.neighbour[700] + 17) % 360;
  EXPECT_FALSE(find_rings(one_bond_off).has_value());
}

// Within a parallel region OpenMP gives a team of one: it must step all the tiles.
TEST(Ring, StepsAllTilesWithFewerThreadsThanAskedFor) {
  const Problem problem = make_problem(touching_scene());
  for (const char* kernel : {"ring", "annulus"}) {
    auto one = make_stepper(problem, forced(kernel, 1));
    one->advance(1500);
    auto three = make_stepper(problem, forced(kernel, 3));
#pragma omp parallel num_threads(2)
#pragma omp single
    three->advance(1500);
    EXPECT_TRUE(same_state(three->state(), one->state())) << kernel;
  }
}

// Four ways through one ball: a loop (512 columns of vectors with 4 lanes), tiles by two to four
// threads, a tile by one (1024 columns are more than a loop keeps).
TEST(Ring, SameBitsWhicheverWayItIsWalked) {
  Scene scene = touching_scene();
  scene.law.rest = Rest::geometry;
  scene.law.elasticity = 0.1;  // 0.015 cm from particle to particle
  scene.ball.rounding = Rounding::none;
  scene.ball.per_ring = 2048;
  for (const Method& method : methods()) {
    scene.time.method = method.name;
    const Problem problem = make_problem(scene);
    PlanRequest request = forced("ring");
    request.vector = "avx2";
    const std::int64_t steps = 2011 / method.evaluations, half = steps / 2;
    auto loop = make_stepper(problem, request);
    loop->advance(steps);
    const State expected = loop->state();
    for (const int threads : {2, 3, 4}) {
      request.threads = threads;
      auto tiles = make_stepper(problem, request);
      tiles->advance(half);
      tiles->advance(steps - half);
      EXPECT_TRUE(same_state(tiles->state(), expected)) << threads << " threads, " << method.name;
    }
  }
  scene.ball.per_ring = 4096;
  scene.law.elasticity = 0.01;
  const Problem large = make_problem(scene);
  auto one = make_stepper(large, forced("ring", 1)), two = make_stepper(large, forced("ring", 2));
  one->advance(1500);
  two->advance(1500);
  EXPECT_TRUE(same_state(one->state(), two->state()));
  EXPECT_TRUE(is_finite(one->state()));
}

TEST(Ring, TakesAsManyThreadsAsPay) {
  EXPECT_EQ(team_size(5), 1);
  EXPECT_EQ(team_size(30), std::min(2, default_threads()));
  EXPECT_EQ(team_size(100000), default_threads());
}

TEST(Ring, CountsItsMultiplications) {
  const auto a_column = [](const Scene& scene) {
    const Problem problem = make_problem(scene);
    return ring_multiplications(problem, find_rings(problem.bonds)->rings, 1);
  };
  EXPECT_EQ(a_column(touching_scene()), 84);  // ring_columns-inl.hpp counts them
  // annulus_stepper-inl.hpp counts them: 35 a ring, and of the outermost ring 11.
  EXPECT_EQ(annulus_multiplications(make_problem(touching_scene()), 3, 1), 2 * 35 + 11);
  EXPECT_EQ(a_column(law_scene(7, 13)), 84 + 7 * 3);
  Scene leapfrog = touching_scene();
  leapfrog.time.method = "leapfrog";
  EXPECT_EQ(a_column(leapfrog), 84);  // one evaluation a step
}

// A wall a hundred rings thick, in more bond classes than eight bits hold.
TEST(Rings, StepAThickAnnulusLikePlainCode) {
  Scene scene = touching_scene();
  scene.law.rest = Rest::geometry;
  scene.ball.rounding = Rounding::none;
  scene.ball.radii.clear();
  for (int r = 0; r < 150; ++r) scene.ball.radii.push_back(5.0 + 0.25 * r);
  scene.ball.per_ring = 40;
  scene.ball.centre.y = 5.0 + 0.25 * 149 + 1e-4;
  const Problem problem = make_problem(scene);
  ASSERT_EQ(problem.classes.size(), 299U);
  State plain = problem.initial;
  constexpr int steps = 200;
  for (int s = 0; s < steps; ++s) plain = scalar_step(problem, plain);
  auto one = make_stepper(problem, forced("annulus", 1));
  one->advance(steps);
  // An ULP of 85 cm a step, ten-fold for contact.
  EXPECT_LE(largest_difference(one->state(), plain), 10 * steps * 1.5e-14);
  auto three = make_stepper(problem, forced("annulus", 3));
  three->advance(steps);
  EXPECT_TRUE(same_state(one->state(), three->state()));
}

TEST(Mirror, KeepsTheBallSymmetricToTheLastBit) {
  Scene scene = touching_scene();
  scene.ball.velocity.x = 0.0;
  const Problem problem = make_problem(scene);
  const RingShape shape = *find_rings(problem.bonds);
  auto half = make_stepper(problem, forced("mirror"));
  half->advance(3000);
  EXPECT_EQ(not_symmetric(half->state(), shape, find_mirror_axis(problem, shape).sum), "");
  EXPECT_FALSE(same_state(half->state(), problem.initial));
}

TEST(Mirror, RefusesAStateThatIsNotSymmetric) {
  Scene scene = touching_scene();
  scene.ball.velocity.x = 0.0;
  const Problem problem = make_problem(scene);
  auto half = make_stepper(problem, forced("mirror"));
  Snapshot snapshot = half->save();
  snapshot.state.vx[7] = 1e-9;
  EXPECT_THROW(half->restore(snapshot), std::invalid_argument);
}

}  // namespace
}  // namespace bounce
