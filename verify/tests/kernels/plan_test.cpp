// The plan: which kernel it takes, what it refuses, and what it says of both.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>

#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "kernels/stepping/threads.hpp"
#include "verify/tests/kernels/kernel_scenes.hpp"

namespace bounce {
namespace {

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
  two.more_threads_than_cores = true;
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

// 12 columns come out even with 4 lanes only: a plan names what runs, and a forced target is
// refused rather than answered by another one.
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
  EXPECT_EQ(make_plan(make_problem(touching_disc_scene())).kernel, "csr");
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

bool says(const Plan& plan, const std::string& begin) {
  return std::any_of(plan.reasons.begin(), plan.reasons.end(),
                     [&begin](const std::string& why) { return why.starts_with(begin); });
}

// The kernel, and with it the bits, are the same for any number of threads.
TEST(Plan, TakesFewerThreadsWhereTheColumnsAreFewAndSaysSo) {
  PlanRequest many = forced("auto", 200);
  many.vector = "avx2";
  const Plan ring = make_plan(make_problem(touching_scene()), many);
  EXPECT_EQ(ring.kernel, "ring");
  EXPECT_EQ(ring.threads, 15);
  EXPECT_TRUE(says(ring, "30 columns of vectors are enough for 15 threads: a thread needs 2"));
  Scene scene = touching_scene();
  scene.law.rest = Rest::geometry;
  scene.ball.radii = {3.0, 4.0, 5.0, 6.0, 7.0};
  const Plan annulus = make_plan(make_problem(scene), many);
  EXPECT_EQ(annulus.kernel, "annulus");
  EXPECT_EQ(annulus.threads, 30);
  EXPECT_TRUE(says(annulus, "30 columns of vectors are enough for 30 threads: a thread needs 1"));
}

// Of this process, now.
std::ptrdiff_t threads_started() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

// They would wait for each other's turn at every stage.
TEST(Plan, StartsNoMoreThreadsThanCores) {
  Scene straight = touching_scene();
  straight.ball.velocity.x = 0.0;
  const Problem problem = make_problem(straight);
  limit_cores(1);
  for (const char* kernel : {"mirror", "ring", "annulus", "csr", "strict"}) {
    SCOPED_TRACE(kernel);
    PlanRequest request = forced(kernel);
    request.more_threads_than_cores = false;
    auto one = make_stepper(problem, request);
    one->advance(1500);
    const std::ptrdiff_t before = threads_started();
    for (const int threads : {16, 256}) {
      request.threads = threads;
      const Plan plan = make_plan(problem, request);
      EXPECT_EQ(plan.threads, 1);
      EXPECT_TRUE(says(plan, std::to_string(threads) + " threads were asked for; the cores"));
      auto stepper = plan.make_stepper();
      stepper->advance(1500);
      EXPECT_EQ(threads_started(), before);
      EXPECT_EQ(state_hash(stepper->state()), state_hash(one->state()));
    }
  }
  PlanRequest forced_to = forced("csr", 3);
  const std::ptrdiff_t before = threads_started();
  make_stepper(problem, forced_to)->advance(3);
  EXPECT_GE(threads_started(), before + 2);  // (some OpenMPs start one of their own beside them)
  limit_cores(std::numeric_limits<int>::max());
}

TEST(Plan, FallsBackToCsrAndSaysWhy) {
  Scene scene = law_scene(1, 3);
  const Plan plan = make_plan(make_problem(scene));
  EXPECT_EQ(plan.kernel, "csr");
  EXPECT_TRUE(says(plan, "not ring: its exponents"));
}

TEST(Plan, RefusesWhatItCannotDoAsForced) {
  const Problem paper = make_problem(touching_scene());
  EXPECT_THROW(make_plan(paper, forced("rign")), PlanError);
  EXPECT_THROW(make_plan(paper, forced("ring", -1)), PlanError);
  EXPECT_THROW(make_plan(paper, forced("ring", 257)), PlanError);
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
  EXPECT_FALSE(has(make_plan(make_problem(touching_disc_scene())), "neighbour index and gathers"));
}

}  // namespace
}  // namespace bounce
