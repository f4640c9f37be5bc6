// What a scene takes in memory, against what is said of it beforehand.
#include <malloc.h>

#include <gtest/gtest.h>

#include "kernels/model/ball.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/plan/memory.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

// Of this program, in bytes; 0 where the allocator is another (the sanitizers').
double allocated() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

Scene large_scene(int rings, std::int64_t per_ring) {
  Scene scene;
  scene.ball.radii.clear();
  for (int r = 0; r < rings; ++r) scene.ball.radii.push_back(1000.0 + r);
  scene.ball.per_ring = per_ring;
  scene.ball.rounding = Rounding::none;
  scene.ball.centre = {0.0, 2000.0};
  scene.law.rest = Rest::geometry;
  scene.walls = {Wall{}};
  return scene;
}

struct Case {
  Scene scene;
  std::string kernel;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.kernel << ", " << c.scene.ball.radii.size() << " rings";
}

class MemoryTest : public testing::TestWithParam<Case> {
 protected:
  // Steps the scene with a vector target and holds what that takes against what is said of it.
  static void check(const Case& c, VectorTarget target) {
    const double said = solver_bytes(c.scene, c.kernel);
    const double before = allocated();
    Problem problem = make_problem(c.scene);
    if (allocated() == before) GTEST_SKIP() << "the allocator does not tell";
    PlanRequest request;
    request.kernel = c.kernel;
    request.vector = name_of(target);
    request.threads = 2;
    request.more_threads_than_cores = true;
    const auto stepper = make_stepper(problem, request);
    stepper->advance(3);
    constexpr double fixed = 2e6;
    const double taken = allocated() - before;
    EXPECT_LE(taken, said + fixed);
    // What is said is of four lanes; with eight there are half as many slices.
    if (target == VectorTarget::avx2) {
      EXPECT_LE(said, 1.05 * taken) << "it says far too much";
    }
    EXPECT_LE(said, solver_bytes(c.scene));
    // The bound, once the start is let go: 2 states a particle, 8 bytes an entry where there is an
    // index.
    problem.initial = State();
    const BallSize size = ball_size(c.scene.ball);
    const double index = c.kernel == "ring" ? 0.0 : 8.0 * static_cast<double>(size.entries);
    EXPECT_LE(allocated() - before, 64.0 * static_cast<double>(size.particles) + index + fixed);
  }
};

TEST_P(MemoryTest, TakesNoMoreThanItSays) {
  for (const VectorTarget target : available_vectors()) {
    SCOPED_TRACE(name_of(target));
    check(GetParam(), target);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MemoryTest,
                         testing::Values(Case{large_scene(3, 200000), "ring"},
                                         Case{large_scene(3, 200000), "csr"},
                                         Case{large_scene(3, 200000), "strict"},
                                         Case{large_scene(40, 10000), "csr"}));

// A list is made when it is asked for, once, and goes with all copies.
TEST(Memory, StepperAndCopiesShareTheProblemsBonds) {
  const Scene scene = large_scene(3, 100000);
  const double before = allocated();
  const Problem problem = make_problem(scene);
  if (allocated() == before) GTEST_SKIP() << "the allocator does not tell";
  const double start = 32.0 * 300000;
  EXPECT_LE(allocated() - before, start + 1e5);
  const Model copy = problem;
  EXPECT_EQ(copy.bonds.list().particles(), 300000U);
  const double with_list = allocated() - before;
  EXPECT_GT(with_list, start + 5e6);
  EXPECT_EQ(&copy.bonds.list(), &problem.bonds.list());
  EXPECT_EQ(allocated() - before, with_list);
}

}  // namespace
}  // namespace bounce
