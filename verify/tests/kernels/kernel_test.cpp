// The kernels against plain scalar stepping, against each other's thread counts and restarts, and
// the plan's choices and refusals.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "kernels/csr/slices.hpp"
#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "kernels/rings/mirror_symmetry.hpp"
#include "kernels/rings/ring_forms.hpp"
#include "kernels/rings/ring_shape.hpp"
#include "kernels/stepping/threads.hpp"
#include "verify/tests/kernels/method_names.hpp"

namespace bounce {
namespace {

// Example 2's ball just above the floor and falling fast: it touches within some thousand steps.
Scene touching_scene() {
  Scene scene;
  scene.ball.centre.y = 7.002;
  scene.ball.velocity = {0.5, -2.0};
  scene.walls = {Wall{}};
  return scene;
}

Scene wedge_scene() {
  Scene scene = touching_scene();
  const double h = std::sqrt(0.5);
  scene.walls = {Wall{{h, h}, -2.051, 0.3, -0.7}, Wall{{0.0, 1.0}, 0.0, 1.0, -1.0}};
  return scene;
}

// The same with resolved contact, sticky unless said otherwise.
Scene resolved(Scene scene, double alpha = 0.0, double beta = 0.0) {
  for (Wall& wall : scene.walls) {
    wall.contact = Contact::resolved;
    wall.alpha = alpha;
    wall.beta = beta;
  }
  return scene;
}

Scene law_scene(double p, double q) {
  Scene scene = touching_scene();
  scene.law.p = p;
  scene.law.q = q;
  scene.law.rest = Rest::geometry;
  return scene;
}

// Neighbours as far apart as on ring 1 of the paper's ball.
Scene disc_scene() {
  Scene scene = touching_scene();
  scene.ball.kind = BallKind::disc;
  scene.ball.radii = {2.0};
  scene.ball.spacing = 0.25;
  scene.ball.centre.y = 1.997;
  scene.law.rest = Rest::geometry;
  return scene;
}

PlanRequest forced(const std::string& kernel, int threads = 1) {
  PlanRequest request;
  request.kernel = kernel;
  request.threads = threads;
  return request;
}

std::unique_ptr<Stepper> stepper_of(const Problem& problem, const PlanRequest& request) {
  return make_stepper(problem, request);
}

// The resolved rule from its definition: a straight path from where the particle came from, met by
// the wall at a part of the drift, and another path from there. Resting: came from the wall.
void meet_resolved(const Wall& w, double drift, std::size_t i, const State& from, State& to) {
  const double d = wall_distance(w, to.x[i], to.y[i]);
  const double came = wall_distance(w, from.x[i], from.y[i]);
  const double vn = w.normal.x * to.vx[i] + w.normal.y * to.vy[i];
  const Vec2 t{to.vx[i] - vn * w.normal.x, to.vy[i] - vn * w.normal.y};
  const bool resting = w.beta == 0.0 && w.alpha < 1.0 && came <= 1e-14;
  const double alpha = resting ? 0.0 : w.alpha;
  // Part of the drift; below 0 where a stage stepped back behind the wall before.
  const double meets = came == d ? 1.0 : std::max(came / (came - d), -1.0);
  const double rest = (1.0 - meets) * drift;
  to.vx[i] = alpha * t.x + w.beta * vn * w.normal.x;
  to.vy[i] = alpha * t.y + w.beta * vn * w.normal.y;
  to.x[i] = from.x[i] + meets * drift * (t.x + vn * w.normal.x) + rest * to.vx[i];
  to.y[i] = from.y[i] + meets * drift * (t.y + vn * w.normal.y) + rest * to.vy[i];
}

// One stage, written as plainly as can be.
State scalar_stage(const Problem& problem, Stage stage, const State& from) {
  State to = from;
  const BondList& bonds = problem.bonds;
  for (std::size_t i = 0; i < from.size(); ++i) {
    double ax = problem.gravity.x;
    double ay = problem.gravity.y;
    for (std::int64_t e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      const auto j = static_cast<std::size_t>(bonds.neighbour[entry]);
      const double dx = from.x[i] - from.x[j];
      const double dy = from.y[i] - from.y[j];
      const double f = force_over_distance(problem.law, problem.classes[bonds.bond_class[entry]],
                                           dx * dx + dy * dy);
      ax += f * dx;
      ay += f * dy;
    }
    to.vx[i] += stage.kick * problem.step * ax;
    to.vy[i] += stage.kick * problem.step * ay;
    if (stage.drift == 0.0) continue;
    const bool forth = stage.drift > 0.0;  // what steps back meets no wall
    to.x[i] += stage.drift * problem.step * to.vx[i];
    to.y[i] += stage.drift * problem.step * to.vy[i];
    for (const Wall& w : problem.walls) {
      const double d = wall_distance(w, to.x[i], to.y[i]);
      if (d > 0.0 || !forth) continue;
      if (w.contact == Contact::resolved) {
        meet_resolved(w, stage.drift * problem.step, i, from, to);
        continue;
      }
      const double vn = w.normal.x * to.vx[i] + w.normal.y * to.vy[i];
      const double tx = to.vx[i] - vn * w.normal.x;
      const double ty = to.vy[i] - vn * w.normal.y;
      to.x[i] -= 2.0 * d * w.normal.x;
      to.y[i] -= 2.0 * d * w.normal.y;
      to.vx[i] = w.alpha * tx + w.beta * vn * w.normal.x;
      to.vy[i] = w.alpha * ty + w.beta * vn * w.normal.y;
    }
  }
  return to;
}

State scalar_step(const Problem& problem, const State& from) {
  return scalar_stage(problem, {1.0, 1.0}, from);
}

double largest_difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]);
    if (!(d <= largest)) largest = d;  // a NaN stays
  }
  return largest;
}

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
  add("disc", disc_scene(), {"strict", "csr"});
  return all;
}

class KernelTest : public testing::TestWithParam<Case> {};

// 3000 steps, with the floor touched from about step 1000 on. Allowed: two runs that round each
// position once a step to half an ULP of 16 cm may part by an ULP (3.6e-15 cm) a step, and contact,
// which turns velocities round, may amplify that; ten-fold is allowed.
TEST_P(KernelTest, StepsLikePlainCode) {
  const Problem problem = make_problem(GetParam().scene);
  auto stepper = stepper_of(problem, forced(GetParam().kernel));
  State plain = problem.initial;
  constexpr int steps = 3000;
  for (int s = 0; s < steps; ++s) plain = scalar_step(problem, plain);
  stepper->advance(steps);
  EXPECT_LE(largest_difference(stepper->state(), plain), 10 * steps * 3.6e-15);
}

TEST_P(KernelTest, SameBitsForAnyThreadCount) {
  const Problem problem = make_problem(GetParam().scene);
  auto one = stepper_of(problem, forced(GetParam().kernel, 1));
  one->advance(1500);
  const std::uint64_t expected = state_hash(one->state());
  for (int threads = 2; threads <= 4; ++threads) {
    const std::int64_t columns = GetParam().scene.ball.per_ring / 8;  // fewest vectors a ring
    if (GetParam().kernel == "ring" && columns < 2 * threads) break;  // refused
    if (GetParam().kernel == "annulus" && columns < threads) break;   // refused
    auto team = stepper_of(problem, forced(GetParam().kernel, threads));
    team->advance(1000);
    team->advance(500);
    EXPECT_EQ(state_hash(team->state()), expected) << threads << " threads";
  }
}

TEST_P(KernelTest, SameBitsForAnyVectorTarget) {
  const Problem problem = make_problem(GetParam().scene);
  if (available_vectors().size() < 2) GTEST_SKIP() << "one vector target on this processor";
  std::vector<std::uint64_t> hashes;
  // Few columns cannot be dealt to the lanes of each target (NamesTheVectorsThatRun).
  const VectorTarget widest = make_plan(problem, forced(GetParam().kernel)).vector;
  for (const VectorTarget target : {widest, VectorTarget::avx2}) {
    PlanRequest request = forced(GetParam().kernel);
    request.vector = name_of(target);
    auto stepper = stepper_of(problem, request);
    stepper->advance(3000);
    hashes.push_back(state_hash(stepper->state()));
  }
  EXPECT_EQ(hashes.front(), hashes.back());
}

TEST_P(KernelTest, SameBitsAcrossARestart) {
  Scene scene = GetParam().scene;
  if (GetParam().kernel != "strict") scene.time.method = "leapfrog";  // with the kick it holds
  const Problem problem = make_problem(scene);
  auto through = stepper_of(problem, forced(GetParam().kernel));
  through->advance(1201);
  auto first = stepper_of(problem, forced(GetParam().kernel));
  first->advance(700);
  (void)first->state();  // looking must not change anything
  first->advance(1);
  auto second = stepper_of(problem, forced(GetParam().kernel));
  second->restore(first->save());
  second->advance(500);
  EXPECT_EQ(second->step(), 1201);
  EXPECT_EQ(state_hash(second->state()), state_hash(through->state()));
}

INSTANTIATE_TEST_SUITE_P(Cases, KernelTest, testing::ValuesIn(cases()),
                         [](const auto& param) { return param.param.name; });

// ---- every method on every kernel

// The floor is touched from about the 1000th evaluation of the force on, whatever the method; by
// either contact rule on two kernels.
Problem touching_problem(const std::string& method, const std::string& kernel) {
  Scene scene = touching_scene();
  if (kernel == "mirror") scene.ball.velocity.x = 0.0;
  if (kernel == "mirror" || kernel == "annulus") scene = resolved(scene);
  scene.time.method = method;
  scene.time.step *= find_method(method)->evaluations;
  return make_problem(scene);
}

class MethodOnKernel : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  [[nodiscard]] const std::string& kernel() const { return std::get<1>(GetParam()); }
  [[nodiscard]] std::unique_ptr<Stepper> stepper(int threads = 1) const {
    return stepper_of(problem_, forced(kernel(), threads));
  }
  [[nodiscard]] std::int64_t steps_of(std::int64_t evaluations) const {
    return evaluations / problem_.method->evaluations;
  }
  Problem problem_ = touching_problem(std::get<0>(GetParam()), std::get<1>(GetParam()));
};

// The table, stage by stage: the first step with all its stages but the last, each further one with
// that last one joined to its first. The same bound as above, an evaluation for a step.
TEST_P(MethodOnKernel, StepsLikeItsTable) {
  const std::span<const Stage> table = problem_.method->stages;
  const bool holds = problem_.method->first_same_as_last;
  const std::int64_t steps = steps_of(3000);
  State plain = problem_.initial;
  for (std::int64_t s = 0; s < steps; ++s) {
    Stage first = table.front();
    if (holds && s > 0) first = {first.kick + table.back().kick, first.drift + table.back().drift};
    plain = scalar_stage(problem_, first, plain);
    for (std::size_t k = 1; k + (holds ? 1 : 0) < table.size(); ++k) {
      plain = scalar_stage(problem_, table[k], plain);
    }
  }
  if (holds) plain = scalar_stage(problem_, table.back(), plain);
  const auto kernel = stepper();
  kernel->advance(steps);
  EXPECT_LE(largest_difference(kernel->state(), plain), 10 * 3000 * 3.6e-15);
}

// Read, cut, saved and taken over by another team anywhere, also where the stage held over would
// mirror a particle.
TEST_P(MethodOnKernel, SameBitsForAnyThreadsReadingsAndRestarts) {
  const std::int64_t steps = steps_of(2400);
  const auto through = stepper();
  through->advance(steps);
  const std::uint64_t expected = state_hash(through->state());
  const std::uint64_t held = state_hash(through->save().state);
  for (const int threads : {1, 2, 3}) {
    auto cut = stepper(threads);
    for (std::int64_t step = 0, piece = 1; step < steps; step += piece, piece = piece % 7 + 1) {
      piece = std::min(piece, steps - step);
      cut->advance(piece);
      EXPECT_TRUE(is_finite(cut->state()));
      if (piece != 3) continue;
      auto next = stepper(4 - threads);
      next->restore(cut->save());
      cut = std::move(next);
    }
    EXPECT_EQ(cut->step(), steps);
    EXPECT_EQ(state_hash(cut->state()), expected) << threads << " threads";
    EXPECT_EQ(state_hash(cut->save().state), held) << threads << " threads";
  }
}

// A state that is read out stands before all walls, though the stage held over has a drift.
TEST_P(MethodOnKernel, NothingReadOutIsBehindAWall) {
  const auto kernel = stepper();
  int touched = 0;
  for (std::int64_t step = 0; step < steps_of(2400); ++step) {
    kernel->advance(1);
    const State now = kernel->state();
    const double lowest = *std::min_element(now.y.begin(), now.y.end());
    EXPECT_GE(lowest, 0.0);
    touched += lowest < 1e-5 ? 1 : 0;
  }
  EXPECT_GT(touched, 10);
}

INSTANTIATE_TEST_SUITE_P(All, MethodOnKernel,
                         testing::Combine(testing::ValuesIn(method_names()),
                                          testing::Values("csr", "ring", "annulus", "mirror")),
                         [](const auto& param) {
                           return test_name(std::get<0>(param.param) + "_" +
                                            std::get<1>(param.param));
                         });

TEST(StateHash, SeesOneBit) {
  State state(4);
  const std::uint64_t before = state_hash(state);
  state.vy[3] = std::nextafter(0.0, 1.0);
  EXPECT_NE(state_hash(state), before);
  state.vy[3] = -0.0;
  EXPECT_NE(state_hash(state), before);
}

TEST(Plan, TakesTheRingKernelForThePapersBall) {
  const Plan plan = make_plan(make_problem(touching_scene()));
  EXPECT_EQ(plan.kernel, "ring");
  EXPECT_EQ(plan.vector, available_vectors().front());
}

TEST(Plan, TakesHalfTheBallWhereItIsSymmetricAndSaysWhyNot) {
  const auto refused = [](const Scene& scene, const std::string& why) {
    const Problem problem = make_problem(scene);
    EXPECT_EQ(make_plan(problem).kernel, "ring");
    EXPECT_NE(make_plan(problem).reasons.back().find("not mirror: " + why), std::string::npos)
        << make_plan(problem).reasons.back();
    EXPECT_THROW(make_plan(problem, forced("mirror")), PlanError);
  };
  Scene straight = touching_scene();
  straight.ball.velocity.x = 0.0;
  EXPECT_EQ(make_plan(make_problem(straight)).kernel, "mirror");
  const std::string asymmetric = "it is not left-right symmetric: ";
  refused(touching_scene(), asymmetric + "particles 1 and 61");
  Scene scene = straight;
  scene.gravity.x = 1e-30;
  refused(scene, asymmetric + "gravity");
  scene = straight;
  scene.walls = {Wall{{0.6, 0.8}, -2.0, 0.0, 0.0}};
  refused(scene, asymmetric + "a wall");
  scene = straight;
  scene.ball.centre.x = 1.0;
  refused(scene, asymmetric + "particle 1 has no mirror image");
  PlanRequest two;
  two.threads = 2;
  EXPECT_EQ(make_plan(make_problem(straight), two).kernel, "mirror");
  two.threads = 10;  // more than it has columns for: it takes fewer, and says so
  const Plan plan = make_plan(make_problem(straight), two);
  EXPECT_EQ(plan.kernel, "mirror");
  EXPECT_EQ(plan.threads, plan.lanes == 8 ? 2 : 5);
  // An initial file with one particle off by one bit.
  State start = make_problem(straight).initial;
  start.y[200] = std::nextafter(start.y[200], 0.0);
  EXPECT_EQ(make_plan(make_problem(straight, start)).kernel, "ring");
}

// 12 columns come out even with 4 lanes only: a plan names what runs, and a forced target is refused
// rather than answered by another one.
TEST(Plan, NamesTheVectorsThatRun) {
  Scene scene = touching_scene();
  scene.law.rest = Rest::geometry;
  scene.ball.per_ring = 12;
  scene.ball.velocity = {0.5, -2.0};
  for (const char* kernel : {"ring", "annulus"}) {
    const Plan plan = make_plan(make_problem(scene), forced(kernel));
    EXPECT_EQ(plan.vector, VectorTarget::avx2) << kernel;
    EXPECT_EQ(plan.lanes, 4) << kernel;
    PlanRequest wide = forced(kernel);
    wide.vector = "avx512";
    EXPECT_THROW(make_plan(make_problem(scene), wide), PlanError) << kernel;
  }
  for (const VectorTarget target : available_vectors()) {
    PlanRequest request;
    request.vector = name_of(target);
    const Plan plan = make_plan(make_problem(touching_scene()), request);
    EXPECT_EQ(plan.vector, target);
    EXPECT_EQ(plan.lanes, lanes_of(target));
  }
}

// Within a parallel region OpenMP gives a team of one: it must step all the tiles.
TEST(Ring, StepsAllTilesWithFewerThreadsThanAskedFor) {
  const Problem problem = make_problem(touching_scene());
  for (const char* kernel : {"ring", "annulus"}) {
    auto one = stepper_of(problem, forced(kernel, 1));
    one->advance(1500);
    auto three = stepper_of(problem, forced(kernel, 3));
#pragma omp parallel num_threads(2)
#pragma omp single
    three->advance(1500);
    EXPECT_EQ(state_hash(three->state()), state_hash(one->state())) << kernel;
  }
}

TEST(Plan, TakesRingsWhereRingIsNotCompiled) {
  Scene scene = touching_scene();
  scene.law.rest = Rest::geometry;
  scene.ball.radii = {3.0, 4.0, 5.0, 6.0, 7.0};
  EXPECT_EQ(make_plan(make_problem(scene)).kernel, "annulus");
  scene.ball.per_ring = 121;
  EXPECT_EQ(make_plan(make_problem(scene)).kernel, "csr");
  EXPECT_THROW(make_plan(make_problem(scene), forced("annulus")), PlanError);
  scene = law_scene(7, 13);
  scene.ball.radii = {5.0, 6.0};
  EXPECT_EQ(make_plan(make_problem(scene)).kernel, "annulus");
  scene.ball.radii = {5.0};
  EXPECT_EQ(make_plan(make_problem(scene)).kernel, "csr");
  EXPECT_EQ(make_plan(make_problem(disc_scene())).kernel, "csr");
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
  auto one = stepper_of(problem, forced("annulus", 1));
  one->advance(steps);
  // An ULP of 85 cm a step, ten-fold for contact.
  EXPECT_LE(largest_difference(one->state(), plain), 10 * steps * 1.5e-14);
  auto three = stepper_of(problem, forced("annulus", 3));
  three->advance(steps);
  EXPECT_EQ(state_hash(one->state()), state_hash(three->state()));
}

TEST(Plan, GivesALargeBallAllThreads) {
  Scene scene = touching_scene();
  scene.law.rest = Rest::geometry;
  scene.ball.rounding = Rounding::none;
  for (const char* kernel : {"annulus", "csr"}) {
    scene.ball.per_ring = 120;
    EXPECT_EQ(make_plan(make_problem(scene), forced(kernel, 0)).threads, 1);
    scene.ball.per_ring = 7000;
    EXPECT_EQ(make_plan(make_problem(scene), forced(kernel, 0)).threads, default_threads());
    EXPECT_EQ(make_plan(make_problem(scene), forced(kernel, 1)).threads, 1);
  }
}

// Four walks over one ball: a loop (512 columns of vectors with 4 lanes), tiles by two to four
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
    auto loop = stepper_of(problem, request);
    loop->advance(steps);
    const std::uint64_t expected = state_hash(loop->state());
    for (const int threads : {2, 3, 4}) {
      request.threads = threads;
      auto tiles = stepper_of(problem, request);
      tiles->advance(half);
      tiles->advance(steps - half);
      EXPECT_EQ(state_hash(tiles->state()), expected) << threads << " threads, " << method.name;
    }
  }
  scene.ball.per_ring = 4096;
  scene.law.elasticity = 0.01;
  const Problem large = make_problem(scene);
  auto one = stepper_of(large, forced("ring", 1)), two = stepper_of(large, forced("ring", 2));
  one->advance(1500);
  two->advance(1500);
  EXPECT_EQ(state_hash(one->state()), state_hash(two->state()));
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
  // rings_stepper-inl.hpp counts them: 35 a ring, and of the outermost ring 11.
  EXPECT_EQ(annulus_multiplications(make_problem(touching_scene()), 3, 1), 2 * 35 + 11);
  EXPECT_EQ(a_column(law_scene(7, 13)), 84 + 7 * 3);
  Scene leapfrog = touching_scene();
  leapfrog.time.method = "leapfrog";
  EXPECT_EQ(a_column(leapfrog), 84);  // one evaluation a step
}

TEST(Mirror, KeepsTheBallSymmetricToTheLastBit) {
  Scene scene = touching_scene();
  scene.ball.velocity.x = 0.0;
  const Problem problem = make_problem(scene);
  const RingShape shape = *find_rings(problem.bonds);
  auto half = stepper_of(problem, forced("mirror"));
  half->advance(3000);
  EXPECT_EQ(not_symmetric(half->state(), shape, find_mirror_axis(problem, shape).sum), "");
  EXPECT_NE(state_hash(half->state()), state_hash(problem.initial));
}

TEST(Mirror, RefusesAStateThatIsNotSymmetric) {
  Scene scene = touching_scene();
  scene.ball.velocity.x = 0.0;
  const Problem problem = make_problem(scene);
  auto half = stepper_of(problem, forced("mirror"));
  Snapshot snapshot = half->save();
  snapshot.state.vx[7] = 1e-9;
  EXPECT_THROW(half->restore(snapshot), std::invalid_argument);
}

TEST(Plan, FallsBackToCsrAndSaysWhy) {
  Scene scene = law_scene(1, 3);
  const Plan plan = make_plan(make_problem(scene));
  EXPECT_EQ(plan.kernel, "csr");
  EXPECT_TRUE(std::any_of(plan.reasons.begin(), plan.reasons.end(), [](const std::string& why) {
    return why.rfind("not ring: its exponents", 0) == 0;
  }));
}

TEST(Plan, RefusesWhatItCannotDoAsForced) {
  const Problem paper = make_problem(touching_scene());
  EXPECT_THROW(make_plan(paper, forced("rign")), PlanError);
  EXPECT_THROW(make_plan(paper, forced("ring", -1)), PlanError);
  EXPECT_THROW(make_plan(paper, forced("ring", 257)), PlanError);
  EXPECT_THROW(make_plan(paper, forced("ring", 200)), PlanError);  // more than its columns
  PlanRequest vector;
  vector.vector = "mmx";
  EXPECT_THROW(make_plan(paper, vector), PlanError);
  EXPECT_THROW(make_plan(make_problem(law_scene(1, 3)), forced("ring")), PlanError);
  EXPECT_THROW(make_plan(make_problem(law_scene(2, 4)), forced("strict")), PlanError);
  Scene leapfrog = touching_scene();
  leapfrog.time.method = "leapfrog";
  EXPECT_THROW(make_plan(make_problem(leapfrog), forced("strict")), PlanError);
}

TEST(Plan, NamesWhatIsLeftOut) {
  Scene scene = touching_scene();
  const auto has = [](const Plan& plan, const std::string& what) {
    return std::find(plan.left_out.begin(), plan.left_out.end(), what) != plan.left_out.end();
  };
  EXPECT_TRUE(has(make_plan(make_problem(scene)), "square root"));
  EXPECT_TRUE(has(make_plan(make_problem(scene)), "neighbour index and gathers"));
  EXPECT_FALSE(has(make_plan(make_problem(law_scene(2, 4))), "square root"));
  EXPECT_FALSE(has(make_plan(make_problem(law_scene(2.5, 4.5))), "pow"));
  EXPECT_FALSE(has(make_plan(make_problem(disc_scene())), "neighbour index and gathers"));
}

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

TEST(Slices, HoldEveryEntryOfTheListOnce) {
  for (const auto& [rings, per_ring] : {std::pair{3, 120}, {5, 121}, {1, 7}}) {
    const BondList bonds = ring_bonds(rings, per_ring);
    for (const int lanes : {1, 4, 8}) {
      const SlicedBonds sliced = slice_bonds(bonds, lanes);
      std::size_t entries = 0;
      for (std::size_t s = 0; s < sliced.slices.size(); ++s) {
        for (std::int32_t k = 0; k < sliced.slices[s].all; ++k) {
          const SliceEntry entry =
              sliced.entries[static_cast<std::size_t>(sliced.slices[s].begin + k)];
          for (std::size_t l = 0; l < static_cast<std::size_t>(lanes); ++l) {
            const auto width = static_cast<std::size_t>(lanes);
            const int bond_class =
                sliced.combinations[static_cast<std::size_t>(entry.combination) * width + l];
            if (bond_class == no_bond) continue;
            const std::size_t i = s * width + l;
            const auto e = static_cast<std::size_t>(bonds.start[i] + k);
            const std::int64_t neighbour =
                entry.first >= 0
                    ? entry.first + static_cast<std::int64_t>(l)
                    : sliced.scattered[static_cast<std::size_t>(-1 - entry.first) * width + l];
            EXPECT_EQ(neighbour, bonds.neighbour[e]);
            EXPECT_EQ(bond_class, bonds.bond_class[e]);
            ++entries;
          }
        }
      }
      EXPECT_EQ(entries, bonds.entries());
    }
  }
}

}  // namespace
}  // namespace bounce
