// The steps at which a run writes something.
#include "driver/run/schedule.hpp"

#include <gtest/gtest.h>

namespace bounce {
namespace {

std::vector<std::int64_t> frames(const Schedule& schedule) {
  std::vector<std::int64_t> steps;
  if (schedule.frame_due(0)) steps.push_back(0);
  for (std::int64_t step = 0; step < schedule.end();) {
    const std::int64_t next = schedule.next(step);
    EXPECT_GT(next, step);
    if (next <= step) break;
    step = next;
    if (schedule.frame_due(step)) steps.push_back(step);
  }
  return steps;
}

Scene quiet_scene() {
  Scene scene;
  scene.output.monitor_every = 1e6;  // s: at the start and the end only
  return scene;
}

TEST(ScheduleTest, EveryFrameOfAnIntervalIsTakenOnce) {
  Scene scene = quiet_scene();
  // Neither k times 0.07 nor a step over 1e-6 is exact in binary; the frames are all the same.
  for (const double every : {0.07, 0.1, 0.3, 1e-3}) {
    scene.output.frames_every = every;
    const std::vector<std::int64_t> found = frames(Schedule(scene, false));
    const auto interval = scene.steps_until(every);
    ASSERT_EQ(static_cast<std::int64_t>(found.size()), 15'000'000 / interval + 1) << every;
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(found[k], static_cast<std::int64_t>(k) * interval) << every;
    }
  }
}

TEST(ScheduleTest, FramesAtTimesComeInOrderAndOnce) {
  Scene scene = quiet_scene();
  scene.output.frames_at = {8.5, 0.0, 1.5, 15.0, 1.5};
  EXPECT_EQ(frames(Schedule(scene, false)),
            (std::vector<std::int64_t>{0, 1'500'000, 8'500'000, 15'000'000}));
  scene.output.frames_at = {3.0};
  EXPECT_EQ(frames(Schedule(scene, false)), (std::vector<std::int64_t>{3'000'000}));
  scene.output.frames_at.clear();
  EXPECT_EQ(frames(Schedule(scene, false)), (std::vector<std::int64_t>{}));
}

// A time between two steps is taken at the nearer one, whatever it is that happens then.
TEST(ScheduleTest, TimesBetweenStepsGoToTheNearerOne) {
  Scene scene = quiet_scene();
  scene.time.step = 0.25;
  scene.time.end = 100.1;  // 400.4 steps
  scene.output.frames_at = {0.1, 1.2, 1.3, 4.9, 100.1};
  EXPECT_EQ(frames(Schedule(scene, false)), (std::vector<std::int64_t>{0, 5, 20, 400}));
  scene.output.frames_at.clear();
  scene.output.frames_every = 33.3;  // 133.2, 266.4, 399.6 steps
  EXPECT_EQ(frames(Schedule(scene, false)), (std::vector<std::int64_t>{0, 133, 266, 400}));
  scene.output.frames_every.reset();
  scene.output.monitor_every = 0.7;  // 2.8 steps, and whole multiples of what that is rounded to
  const Schedule schedule(scene, false);
  EXPECT_EQ(schedule.next(0), 3);
  EXPECT_EQ(schedule.next(3), 6);
  EXPECT_EQ(schedule.end(), 400);
  scene.time.end = 99.9;  // 399.6
  EXPECT_EQ(Schedule(scene, false).end(), 400);
}

TEST(ScheduleTest, SamplesComeAtTheirIntervalAndAtTheEnd) {
  Scene scene;
  scene.time.end = 0.025;
  const Schedule schedule(scene, false);
  EXPECT_EQ(schedule.next(0), 10'000);
  EXPECT_EQ(schedule.next(10'000), 20'000);
  EXPECT_EQ(schedule.next(20'000), 25'000);
  for (const std::int64_t step : {0, 10'000, 20'000, 25'000})
    EXPECT_TRUE(schedule.sample_due(step));
  EXPECT_FALSE(schedule.sample_due(15'000));
  EXPECT_FALSE(schedule.listing_frame_due(25'000));
}

TEST(ScheduleTest, TheListingsFramesComeEachMillionStepsAndAtTheEnd) {
  Scene scene = quiet_scene();
  scene.time.end = 2.5;
  const Schedule schedule(scene, true);
  EXPECT_EQ(schedule.next(0), 1'000'000);
  EXPECT_EQ(schedule.next(1'000'000), 2'000'000);
  EXPECT_EQ(schedule.next(2'000'000), 2'500'000);
  EXPECT_FALSE(schedule.listing_frame_due(0));
  EXPECT_TRUE(schedule.listing_frame_due(1'000'000));
  EXPECT_TRUE(schedule.listing_frame_due(2'500'000));
}

}  // namespace
}  // namespace bounce
