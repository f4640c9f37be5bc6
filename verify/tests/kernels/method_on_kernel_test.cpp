// Every method on every kernel that takes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/tests/kernels/kernel_scenes.hpp"
#include "verify/tests/kernels/method_names.hpp"
#include "verify/tests/kernels/plain_steps.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

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
    return make_stepper(problem_, forced(kernel(), threads));
  }
  [[nodiscard]] std::int64_t steps_of(std::int64_t evaluations) const {
    return evaluations / problem_.method->evaluations;
  }
  Problem problem_ = touching_problem(std::get<0>(GetParam()), std::get<1>(GetParam()));
};

// The table, stage by stage: the first step with all its stages but the last, each further one
// with that last one joined to its first. The bound of KernelTest.StepsLikePlainCode, an
// evaluation for a step.
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
  const State expected = through->state(), held = through->save().state;
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
    EXPECT_TRUE(same_state(cut->state(), expected)) << threads << " threads";
    EXPECT_TRUE(same_state(cut->save().state, held)) << threads << " threads";
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

}  // namespace
}  // namespace bounce
