// The same bits for any number of lanes. Vectors of 1, 2 and 4 lanes are built here on purpose, so
// that the claim is tested also where a processor has but one vector target.
#define HWY_COMPILE_ONLY_STATIC
#include <gtest/gtest.h>

#include "kernels/csr/csr_physics-inl.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/rings/mirror_stepper-inl.hpp"
#include "kernels/rings/ring_stepper-inl.hpp"
#include "verify/tests/kernels/method_names.hpp"
#include "verify/tests/same_state.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

Problem touching_problem(const std::string& method) {
  Scene scene;
  scene.ball.centre.y = 7.002;
  scene.ball.velocity = {0.5, -2.0};
  scene.walls = {Wall{{0.0, 1.0}, 0.0, 0.4, -0.6}};
  scene.time.method = method;
  scene.time.step *= find_method(method)->evaluations;
  return make_problem(scene);
}

// 4000 evaluations of the force; the floor is touched from about the 1000th on.
std::int64_t steps_of(const Problem& problem) { return 4000 / problem.method->evaluations; }

template <size_t lanes>
State ring_state(const Problem& problem, int threads) {
  using D = hn::FixedTag<double, lanes>;
  RingStepper<D, FixedLaw<4, 2>, 3> stepper(problem, *find_rings(problem.bonds), threads);
  stepper.advance(steps_of(problem));
  return stepper.state();
}

template <size_t lanes>
State mirror_state(const Problem& problem, int threads) {
  using D = hn::FixedTag<double, lanes>;
  const RingShape shape = *find_rings(problem.bonds);
  MirrorStepper<D, FixedLaw<4, 2>, 3> stepper(problem, shape, find_mirror_axis(problem, shape).sum,
                                              threads);
  stepper.advance(steps_of(problem));
  return stepper.state();
}

template <size_t lanes>
State csr_state(const Problem& problem, int threads) {
  using D = hn::FixedTag<double, lanes>;
  SlicedStepper<FastPhysics<D, FixedLaw<4, 2>>> stepper(problem, threads);
  stepper.advance(steps_of(problem));
  return stepper.state();
}

TEST(Lanes, DoNotChangeABitOfRing) {
  for (const std::string& method : method_names()) {
    const Problem problem = touching_problem(method);
    const State four = ring_state<4>(problem, 1);
    EXPECT_TRUE(same_state(ring_state<1>(problem, 1), four)) << method;
    EXPECT_TRUE(same_state(ring_state<2>(problem, 1), four));
    EXPECT_TRUE(same_state(ring_state<1>(problem, 3), four));
    EXPECT_TRUE(same_state(ring_state<2>(problem, 2), four));
  }
}

// 60 columns of half a ball are dealt evenly, 14, 34 and 166 are not.
TEST(Lanes, DoNotChangeABitOfMirror) {
  for (const int columns : {120, 28, 68, 332}) {
    Scene scene;
    scene.ball.per_ring = columns;
    if (columns != 120) scene.law.rest = Rest::geometry;
    scene.ball.centre.y = 7.002;
    scene.ball.velocity = {0.0, -2.0};
    scene.walls = {Wall{{0.0, 1.0}, 0.0, 0.4, -0.6}};
    const Problem problem = make_problem(scene);
    const State four = mirror_state<4>(problem, 1);
    EXPECT_TRUE(same_state(mirror_state<1>(problem, 2), four)) << columns;
    EXPECT_TRUE(same_state(mirror_state<2>(problem, 2), four)) << columns;
  }
}

TEST(Lanes, DoNotChangeABitOfCsr) {
  for (const std::string& method : method_names()) {
    const Problem problem = touching_problem(method);
    const State four = csr_state<4>(problem, 1);
    EXPECT_TRUE(same_state(csr_state<1>(problem, 1), four));
    EXPECT_TRUE(same_state(csr_state<2>(problem, 2), four));
  }
}

// Rows of different length in one vector, and a last vector that is not full.
TEST(Lanes, DoNotChangeABitOfCsrOnRaggedRows) {
  Scene scene;
  scene.ball.per_ring = 13;
  scene.law.rest = Rest::geometry;
  scene.ball.centre.y = 7.002;
  scene.ball.velocity = {0.5, -2.0};
  scene.walls = {Wall{}};
  const Problem problem = make_problem(scene);
  const State four = csr_state<4>(problem, 1);
  EXPECT_TRUE(same_state(csr_state<1>(problem, 1), four));
  EXPECT_TRUE(same_state(csr_state<2>(problem, 1), four));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();
