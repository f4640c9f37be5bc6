// What a scene may be: each value out of its limits is refused by name.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <string>

#include "kernels/model/problem.hpp"
#include "kernels/model/scene.hpp"
#include "verify/tests/kernels/kernel_scenes.hpp"
#include "verify/tests/paper_scenes.hpp"

namespace bounce {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Scene, StepsAreCountedInTheNominalStep) {
  const Scene scene = paper_scene(2);
  EXPECT_EQ(scene.steps_until(15.0), 15000000);
  EXPECT_EQ(scene.steps_until(0.01), 10000);
}

TEST(Scene, AcceptsTheExamples) {
  for (int example = 1; example <= 7; ++example) {
    EXPECT_NO_THROW(make_problem(paper_scene(example))) << example;
  }
}

struct BadValue {
  std::string key;
  std::function<void(Scene&)> spoil;
};
void PrintTo(const BadValue& bad, std::ostream* out) { *out << bad.key; }

class SceneLimits : public testing::TestWithParam<BadValue> {};

TEST_P(SceneLimits, NamesTheKeyAndWhatIsAllowed) {
  Scene scene = paper_scene(2);
  GetParam().spoil(scene);
  try {
    validate(scene);
    FAIL() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.key, GetParam().key);
    EXPECT_FALSE(error.value.empty());
    EXPECT_FALSE(error.allowed.empty());
    EXPECT_NE(std::string(error.what()).find(error.allowed), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Ball, SceneLimits,
    testing::Values(BadValue{"ball.radii", [](Scene& s) { s.ball.radii.clear(); }},
                    BadValue{"ball.radii", [](Scene& s) { s.ball.radii.resize(1000000); }},
                    BadValue{"ball.radii[0]", [](Scene& s) { s.ball.radii[0] = -5.0; }},
                    BadValue{"ball.radii[0]", [](Scene& s) { s.ball.radii[0] = 0.0; }},
                    BadValue{"ball.radii[1]", [](Scene& s) { s.ball.radii[1] = nan; }},
                    BadValue{"ball.radii[1]", [](Scene& s) { s.ball.radii[1] = 5.0; }},
                    BadValue{"ball.radii[2]", [](Scene& s) { s.ball.radii[2] = infinity; }},
                    BadValue{"ball.per_ring", [](Scene& s) { s.ball.per_ring = 1000000000000; }},
                    BadValue{"ball.per_ring", [](Scene& s) { s.ball.per_ring = 2; }},
                    BadValue{"ball.per_ring", [](Scene& s) { s.ball.per_ring = -120; }},
                    BadValue{"ball.spacing", [](Scene& s) { s.ball.spacing = 0.1; }},
                    BadValue{"ball.radii", [](Scene& s) { s.ball.kind = BallKind::disc; }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, 2.1); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, -0.1); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, 0.0); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, nan); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, 1e-5); }},
                    BadValue{"ball.spacing",
                             [](Scene& s) {
                               s = disc_scene(2.0, 0.1);
                               s.ball.spacing.reset();
                             }},
                    BadValue{"law.rest",
                             [](Scene& s) {
                               s = disc_scene(2.0, 0.1);
                               s.law.rest = Rest::listing;
                             }},
                    BadValue{"ball.centre", [](Scene& s) { s.ball.centre.x = nan; }},
                    BadValue{"ball.velocity", [](Scene& s) { s.ball.velocity.y = infinity; }}));

INSTANTIATE_TEST_SUITE_P(
    Law, SceneLimits,
    testing::Values(BadValue{"law.p", [](Scene& s) { s.law.p = 0.0; }},
                    BadValue{"law.p", [](Scene& s) { s.law.p = nan; }},
                    BadValue{"law.q", [](Scene& s) { s.law.q = 3.0; }},
                    BadValue{"law.q", [](Scene& s) { s.law.q = infinity; }},
                    BadValue{"law.q", [](Scene& s) { s.law.q = nan; }},
                    BadValue{"law.elasticity", [](Scene& s) { s.law.elasticity = 0.0; }},
                    BadValue{"law.elasticity", [](Scene& s) { s.law.elasticity = nan; }},
                    BadValue{"law.rest", [](Scene& s) { s.ball.radii[2] = 8.0; }},
                    BadValue{"gravity.acceleration", [](Scene& s) { s.gravity.y = nan; }}));

INSTANTIATE_TEST_SUITE_P(
    Wall, SceneLimits,
    testing::Values(BadValue{"wall[0].normal",
                             [](Scene& s) {
                               s.walls[0].normal = {1.0, 1.0};
                             }},
                    BadValue{"wall[0].normal",
                             [](Scene& s) {
                               s.walls[0].normal = {0.0, 0.0};
                             }},
                    BadValue{"wall[0].normal", [](Scene& s) { s.walls[0].normal.y = nan; }},
                    BadValue{"wall[0].offset", [](Scene& s) { s.walls[0].offset = infinity; }},
                    BadValue{"wall[0].alpha", [](Scene& s) { s.walls[0].alpha = 1.5; }},
                    BadValue{"wall[0].alpha", [](Scene& s) { s.walls[0].alpha = -0.1; }},
                    BadValue{"wall[0].alpha", [](Scene& s) { s.walls[0].alpha = nan; }},
                    BadValue{"wall[0].beta", [](Scene& s) { s.walls[0].beta = 0.5; }},
                    BadValue{"wall[0].beta", [](Scene& s) { s.walls[0].beta = -1.5; }},
                    BadValue{"wall[0].beta", [](Scene& s) { s.walls[0].beta = nan; }}));

INSTANTIATE_TEST_SUITE_P(
    TimeAndOutput, SceneLimits,
    testing::Values(BadValue{"time.step", [](Scene& s) { s.time.step = 0.0; }},
                    BadValue{"time.step", [](Scene& s) { s.time.step = -1e-6; }},
                    BadValue{"time.step", [](Scene& s) { s.time.step = nan; }},
                    BadValue{"time.end", [](Scene& s) { s.time.end = -1.0; }},
                    BadValue{"time.end", [](Scene& s) { s.time.end = 1e30; }},
                    BadValue{"time.method", [](Scene& s) { s.time.method = "euler"; }},
                    BadValue{"output.frames_every", [](Scene& s) { s.output.frames_every = 0.0; }},
                    BadValue{"output.frames_every", [](Scene& s) { s.output.frames_every = nan; }},
                    BadValue{"output.frames_at[1]",
                             [](Scene& s) {
                               s.output.frames_at = {0.0, 16.0};
                             }},
                    BadValue{"output.frames_at",
                             [](Scene& s) {
                               s.output.frames_every = 1.0;
                               s.output.frames_at = {1.0};
                             }},
                    BadValue{"output.monitor_every",
                             [](Scene& s) { s.output.monitor_every = 0.0; }}));

}  // namespace
}  // namespace bounce
