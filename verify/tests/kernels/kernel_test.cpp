// The kernels against plain scalar stepping, and against each other's thread counts, vectors and
// restarts: generated for every kernel that takes a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <ostream>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/tests/kernels/kernel_scenes.hpp"
#include "verify/tests/kernels/plain_steps.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

struct Case {
  std::string name;
  std::string kernel;
  Scene scene;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&all](const std::string& name, const Scene& scene,
                          std::initializer_list<const char*> kernels) {
    for (const char* kernel : kernels) all.push_back({name + "_" + kernel, kernel, scene});
  };
  Scene no_wall = touching_scene();
  no_wall.walls.clear();
  no_wall.gravity = {};
  Scene rings = touching_scene();
  rings.law.rest = Rest::geometry;
  add("floor", touching_scene(), {"strict", "csr", "ring", "annulus"});
  add("no_wall", no_wall, {"strict", "csr", "ring", "annulus"});
  add("wedge", wedge_scene(), {"strict", "csr", "ring", "annulus"});
  add("ceiling", ceiling_scene(), {"strict", "csr", "ring", "annulus"});
  Scene lid = ceiling_scene();
  lid.ball.velocity.x = 0.0;
  lid.walls.erase(lid.walls.begin());
  add("ceiling_alone", lid, {"strict", "csr", "ring", "annulus", "mirror"});
  add("resolved", resolved(touching_scene()), {"csr", "ring", "annulus"});
  add("resolved_half", resolved(touching_scene(), 0.5, 0.0), {"csr", "ring", "annulus"});
  add("resolved_wedge", resolved(wedge_scene(), 0.3, -0.7), {"csr", "ring", "annulus"});
  add("law_7_13", law_scene(7, 13), {"csr", "ring", "annulus"});
  add("law_2_4", law_scene(2, 4), {"csr", "ring", "annulus"});
  add("law_1_3", law_scene(1, 3), {"csr"});
  add("law_5_11", law_scene(5, 11), {"csr"});
  add("law_half", law_scene(2.5, 4.5), {"csr"});
  Scene straight = touching_scene();
  straight.ball.velocity.x = 0.0;
  add("straight", straight, {"ring", "mirror"});
  add("straight_resolved", resolved(straight), {"ring", "mirror"});
  straight.walls = {Wall{{0.0, 1.0}, 0.0, 0.3, -0.7}, Wall{{0.0, -1.0}, -14.003, 0.3, -0.7}};
  add("squeezed", straight, {"mirror"});
  straight.walls.clear();
  straight.gravity = {};
  add("straight_no_wall", straight, {"mirror"});
  straight = law_scene(7, 13);
  straight.ball.velocity.x = 0.0;
  add("straight_7_13", straight, {"mirror"});
  straight = rings;
  straight.ball.velocity.x = 0.0;
  for (const int n : {1, 2, 4}) {
    straight.ball.radii = {7.0, 6.0, 5.0, 4.0};
    straight.ball.radii.resize(static_cast<std::size_t>(n));
    std::reverse(straight.ball.radii.begin(), straight.ball.radii.end());
    add("straight_rings_" + std::to_string(n), straight, {"mirror"});
  }
  straight.ball.radii = {5.0, 6.0, 7.0};
  for (const int columns : {16, 28, 40, 332}) {  // 8 to 166 of half a ball: sectors not all alike
    straight.ball.per_ring = columns;
    add("straight_columns_" + std::to_string(columns), straight, {"mirror"});
  }
  rings.ball.radii = {7.0};
  add("one_ring", rings, {"strict", "csr", "ring"});
  rings.ball.radii = {6.0, 7.0};
  add("two_rings", rings, {"strict", "csr", "ring", "annulus"});
  rings.ball.radii = {4.0, 5.0, 6.0, 7.0};
  add("four_rings", rings, {"strict", "csr", "ring", "annulus"});
  rings.ball.radii = {3.0, 4.0, 5.0, 6.0, 7.0};
  add("five_rings", rings, {"strict", "csr", "annulus"});
  rings.ball.radii = {5.0, 6.0, 7.0};
  rings.ball.per_ring = 121;
  add("odd_columns", rings, {"strict", "csr"});
  rings.ball.per_ring = 8;
  add("eight_columns", rings, {"strict", "csr", "ring", "annulus"});
  add("disc", touching_disc_scene(), {"strict", "csr"});
  return all;
}

class KernelTest : public testing::TestWithParam<Case> {};

// 3000 steps, with the floor touched from about step 1000 on. Allowed: two runs that round each
// position once a step to half an ULP of 16 cm may part by an ULP (3.6e-15 cm) a step, and contact,
// which turns velocities round, may amplify that; ten-fold is allowed.
TEST_P(KernelTest, StepsLikePlainCode) {
  const Problem problem = make_problem(GetParam().scene);
  auto stepper = make_stepper(problem, forced(GetParam().kernel));
  State plain = problem.initial;
  constexpr int steps = 3000;
  for (int s = 0; s < steps; ++s) plain = scalar_step(problem, plain);
  stepper->advance(steps);
  EXPECT_LE(largest_difference(stepper->state(), plain), 10 * steps * 3.6e-15);
}

TEST_P(KernelTest, SameBitsForAnyThreadCount) {
  const Problem problem = make_problem(GetParam().scene);
  auto one = make_stepper(problem, forced(GetParam().kernel, 1));
  one->advance(1500);
  const State expected = one->state();
  for (int threads = 2; threads <= 4; ++threads) {
    auto team = make_stepper(problem, forced(GetParam().kernel, threads));
    team->advance(1000);
    team->advance(500);
    EXPECT_TRUE(same_state(team->state(), expected))
        << threads << " threads; "
        << where_they_part(
               [&] { return make_stepper(problem, forced(GetParam().kernel, 1)); },
               [&] { return make_stepper(problem, forced(GetParam().kernel, threads)); }, 1500);
  }
}

TEST_P(KernelTest, SameBitsForAnyVectorTarget) {
  const Problem problem = make_problem(GetParam().scene);
  if (available_vectors().size() < 2) GTEST_SKIP() << "one vector target on this processor";
  const auto stepper_for = [&](VectorTarget target) {
    PlanRequest request = forced(GetParam().kernel);
    request.vector = name_of(target);
    return make_stepper(problem, request);
  };
  // Few columns cannot be dealt to the lanes of each target (NamesTheVectorsThatRun).
  const VectorTarget widest = make_plan(problem, forced(GetParam().kernel)).vector;
  const auto wide = stepper_for(widest), narrow = stepper_for(VectorTarget::avx2);
  wide->advance(3000);
  narrow->advance(3000);
  EXPECT_TRUE(same_state(wide->state(), narrow->state())) << where_they_part(
      [&] { return stepper_for(widest); }, [&] { return stepper_for(VectorTarget::avx2); }, 3000);
}

TEST_P(KernelTest, SameBitsAcrossARestart) {
  Scene scene = GetParam().scene;
  if (GetParam().kernel != "strict") scene.time.method = "leapfrog";  // with the kick it holds
  const Problem problem = make_problem(scene);
  auto through = make_stepper(problem, forced(GetParam().kernel));
  through->advance(1201);
  auto first = make_stepper(problem, forced(GetParam().kernel));
  first->advance(700);
  (void)first->state();  // looking must not change anything
  first->advance(1);
  auto second = make_stepper(problem, forced(GetParam().kernel));
  second->restore(first->save());
  second->advance(500);
  EXPECT_EQ(second->step(), 1201);
  EXPECT_TRUE(same_state(second->state(), through->state())) << "after a restart at step 701";
}

INSTANTIATE_TEST_SUITE_P(Cases, KernelTest, testing::ValuesIn(cases()),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace bounce
