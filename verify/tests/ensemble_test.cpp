// The ensemble against the kernel `ring`, scene by scene to the last bit, whatever runs beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/ensemble.hpp"
#include "kernels/stepping/faster_of_two.hpp"
#include "kernels/stepping/plan.hpp"
#include "verify/tests/method_names.hpp"

namespace bounce {
namespace {

constexpr std::int64_t steps = 2500;  // contact begins after 1000, a look at the scene at 2000

// Balls that differ in all that may differ: E, g, step, walls, start.
std::vector<Scene> mixed_scenes() {
  Scene scene;
  scene.ball.centre.y = 7.002;
  scene.ball.velocity = {0.5, -2.0};
  scene.walls = {Wall{}};
  std::vector<Scene> all;
  for (int i = 0; i < 11; ++i) {
    Scene other = scene;
    other.law.elasticity = 1000.0 * (i + 1);
    other.gravity = {0.01 * i, -0.098 * i};
    other.time.step = 1e-6 / (1 + i % 3);
    other.walls[0].offset = -0.001 * (i % 4);
    other.walls[0].alpha = 0.1 * i;
    other.walls[0].beta = -0.1 * i;
    if (i % 3 == 0) other.walls[0] = {.contact = Contact::resolved};
    other.ball.velocity.x = 0.2 * i;
    if (i % 5 == 4) other.walls.clear();
    all.push_back(other);
  }
  return all;
}

std::vector<Scene> scenes_with_wedges() {
  std::vector<Scene> all = mixed_scenes();
  const double h = std::sqrt(0.5);
  for (std::size_t i = 0; i < all.size(); i += 2) {
    all[i].walls = {Wall{{h, h}, -2.051, 0.3, -0.7}, Wall{{0.0, 1.0}, 0.0, 1.0, -1.0}};
    if (i % 4 == 0) all[i].walls[0].contact = Contact::resolved;
  }
  return all;
}

std::vector<Problem> problems_of(std::vector<Scene> scenes, const std::string& method = "listing") {
  std::vector<Problem> all;
  for (Scene& scene : scenes) {
    scene.time.method = method;
    all.push_back(make_problem(scene));
  }
  return all;
}

PlanRequest with_threads(int threads) {
  PlanRequest request;
  request.threads = threads;
  return request;
}

std::uint64_t ring_hash(const Problem& problem, std::int64_t count) {
  PlanRequest request;
  request.kernel = "ring";
  auto stepper = make_stepper(problem, make_plan(problem, request));
  stepper->advance(count);
  return state_hash(stepper->state());
}

void expect_rings_bits(const std::vector<Problem>& problems,
                       const std::vector<int>& teams = {1, 2, 3}) {
  for (const int threads : teams) {
    Ensemble ensemble(problems, with_threads(threads));
    ensemble.advance(steps);
    for (std::size_t i = 0; i < problems.size(); ++i) {
      EXPECT_EQ(state_hash(ensemble.state(i)), ring_hash(problems[i], steps))
          << "scene " << i << ", " << threads << " threads";
      EXPECT_EQ(ensemble.step(i), steps);
    }
  }
}

TEST(Ensemble, GivesRingsBitsToEveryScene) { expect_rings_bits(problems_of(mixed_scenes())); }

TEST(Ensemble, GivesRingsBitsWithAnyWalls) { expect_rings_bits(problems_of(scenes_with_wedges())); }

TEST(Ensemble, GivesRingsBitsWithEveryMethod) {
  for (const std::string& method : method_names()) {
    expect_rings_bits(problems_of(mixed_scenes(), method), {2});
  }
}

TEST(Ensemble, GivesTheSameBitsInAnyBatch) {
  const std::vector<Problem> problems = problems_of(scenes_with_wedges());
  Ensemble all(problems, with_threads(2));
  all.advance(steps);
  std::vector<Problem> turned(problems.rbegin(), problems.rend());
  Ensemble other_order(turned, with_threads(1));
  other_order.advance(steps);
  for (std::size_t i = 0; i < problems.size(); ++i) {
    Ensemble alone(std::span(&problems[i], 1), with_threads(1));
    alone.advance(steps);
    EXPECT_EQ(state_hash(alone.state(0)), state_hash(all.state(i)));
    EXPECT_EQ(state_hash(other_order.state(problems.size() - 1 - i)), state_hash(all.state(i)));
  }
}

TEST(Ensemble, GivesTheSameBitsForAnyVectorTarget) {
  if (available_vectors().size() < 2) GTEST_SKIP() << "one vector target on this processor";
  const std::vector<Problem> problems = problems_of(mixed_scenes());
  PlanRequest narrow = with_threads(1);
  narrow.vector = "avx2";
  Ensemble wide(problems, with_threads(1)), small(problems, narrow);
  EXPECT_GT(wide.lanes(), small.lanes());
  wide.advance(steps);
  small.advance(steps);
  for (std::size_t i = 0; i < problems.size(); ++i) {
    EXPECT_EQ(state_hash(wide.state(i)), state_hash(small.state(i)));
  }
}

// Each scene a number of steps of its own, some none, in several calls and across a restart.
TEST(Ensemble, TakesEachScenesOwnNumberOfSteps) {
  const std::vector<Problem> problems = problems_of(mixed_scenes(), "pefrl");
  Ensemble ensemble(problems, with_threads(2)), second(problems, with_threads(1));
  std::vector<std::int64_t> own(problems.size());
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = 430 * static_cast<std::int64_t>(i);
  ensemble.advance(own);
  for (std::size_t i = 0; i < own.size(); ++i) second.restore(i, ensemble.save(i));
  second.advance(100);
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(ensemble.step(i), own[i]);
    EXPECT_EQ(state_hash(ensemble.state(i)), ring_hash(problems[i], own[i]));
    EXPECT_EQ(state_hash(second.state(i)), ring_hash(problems[i], own[i] + 100));
  }
}

// In scene 3 two neighbours start in one place, so their force is not a number; scene 7 flies
// apart, finite, and only its user knows that no particle should be as fast.
TEST(Ensemble, RetiresASceneThatBlowsUpAndNoOther) {
  std::vector<Scene> scenes = mixed_scenes();
  scenes[7].law.elasticity = 1e12;
  std::vector<Problem> problems = problems_of(scenes, "leapfrog");
  problems[3].initial.x[1] = problems[3].initial.x[0];
  problems[3].initial.y[1] = problems[3].initial.y[0];
  const auto is_good = [](std::size_t, const State& state) {
    return *std::max_element(state.vy.begin(), state.vy.end()) < 1e3;
  };
  Ensemble ensemble(problems, with_threads(2), is_good), unwatched(problems, with_threads(2));
  ensemble.advance(3 * Ensemble::check_every);
  ensemble.advance(100);
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const bool wild = i == 3 || i == 7;
    EXPECT_EQ(ensemble.retired(i), wild) << i;
    EXPECT_EQ(ensemble.step(i), wild ? 0 : 3 * Ensemble::check_every + 100) << i;
    if (i == 3) continue;  // its first kick is not a number
    EXPECT_EQ(state_hash(ensemble.state(i)), ring_hash(problems[i], ensemble.step(i))) << i;
  }
  unwatched.advance(3 * Ensemble::check_every);
  EXPECT_TRUE(unwatched.retired(3));
  EXPECT_FALSE(unwatched.retired(7));
  // A retired scene that is restored works again.
  ensemble.restore(3, Snapshot{problems[3].initial});
  EXPECT_FALSE(ensemble.retired(3));
  EXPECT_EQ(ensemble.step(3), 0);
}

TEST(Ensemble, RefusesScenesOfAnotherKind) {
  const auto refused = [](const std::vector<Scene>& scenes, const std::string& why) {
    try {
      const Ensemble ensemble(problems_of(scenes));
      ADD_FAILURE() << "took " << why;
    } catch (const PlanError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  std::vector<Scene> scenes = mixed_scenes();
  refused({}, "one scene at least");
  scenes[2].law.p = 2.0;
  scenes[2].law.q = 4.0;
  refused(scenes, "scene 2 (from 0) has other exponents");
  scenes = mixed_scenes();
  scenes[1].ball.radii = {5.0, 6.0};
  scenes[1].law.rest = Rest::geometry;
  refused(scenes, "scene 1 (from 0) has other numbers of particles");
  scenes = {mixed_scenes()[0]};
  scenes[0].law.p = 1.0;
  scenes[0].law.q = 3.0;
  refused(scenes, "no ensemble of this scene: its exponents");
  Ensemble two(problems_of({mixed_scenes()[0], mixed_scenes()[1]}));
  EXPECT_THROW(two.advance(std::vector<std::int64_t>{1}), std::invalid_argument);
}

// Drives the choice with made-up times: how often each way was taken in so many slices.
double share_of_second(FasterOfTwo& choice, double first_time, double second_time, int slices) {
  int second = 0;
  for (int s = 0; s < slices; ++s) {
    const int way = choice.next();
    second += way;
    choice.took(way, way == 0 ? first_time : second_time);
  }
  return static_cast<double>(second) / slices;
}

TEST(FasterOfTwo, TakesTheFasterWay) {
  FasterOfTwo faster, slower;
  EXPECT_GT(share_of_second(faster, 1.0, 0.7, 1000), 0.95);
  EXPECT_LT(share_of_second(slower, 1.0, 1.3, 1000), 0.1);
}

TEST(FasterOfTwo, ChangesWhenTheOtherBecomesFaster) {
  FasterOfTwo choice;
  share_of_second(choice, 1.0, 1.3, 500);
  share_of_second(choice, 1.0, 0.7, 3000);
  EXPECT_EQ(choice.best(), 1);
  share_of_second(choice, 1.0, 50.0, 1);
  share_of_second(choice, 1.0, 50.0, 3000);
  EXPECT_EQ(choice.best(), 0);
}

// However slow the other way is, trying it takes less time than the work itself.
TEST(FasterOfTwo, TrialsCostLittle) {
  for (const double slow : {1.1, 3.0, 50.0, 1000.0}) {
    FasterOfTwo choice;
    share_of_second(choice, 1.0, slow, 100);  // the first trial comes early
    double time = 0.0;
    constexpr int slices = 100000;
    for (int s = 0; s < slices; ++s) {
      const double took = choice.next() == 0 ? 1.0 : slow;
      choice.took(choice.next(), took);
      time += took;
    }
    EXPECT_LT(time, 1.05 * slices) << slow;
  }
}

TEST(FasterOfTwo, ANaNNeverWins) {
  FasterOfTwo choice;
  share_of_second(choice, 1.0, std::numeric_limits<double>::quiet_NaN(), 1000);
  EXPECT_EQ(choice.best(), 0);
}

}  // namespace
}  // namespace bounce
