#include "verify/stability/bounce_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/stepping/threads.hpp"
#include "verify/stability/energy_judge.hpp"
#include "verify/stability/vibration.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {
namespace {

double distance_of_ball(const Wall& wall, const State& state) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < state.size(); ++i) {
    nearest = std::min(nearest, wall_distance(wall, state.x[i], state.y[i]));
  }
  return nearest;
}

double distance_of_ball(const Problem& problem, const State& state) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : problem.walls) {
    nearest = std::min(nearest, distance_of_ball(wall, state));
  }
  return nearest;
}

const Wall& nearest_wall(const Problem& problem) {
  return *std::min_element(
      problem.walls.begin(), problem.walls.end(), [&](const Wall& a, const Wall& b) {
        return distance_of_ball(a, problem.initial) < distance_of_ball(b, problem.initial);
      });
}

double along(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

// Takes the states of one bounce in their order, one each `look_every` steps.
class Follower {
 public:
  Follower(const Problem& problem, double growth, std::int64_t look_every)
      : problem_(&problem),
        normal_(nearest_wall(problem).normal),
        look_every_(look_every),
        judge_(problem, growth),
        gauge_(problem) {}

  // True if it is to be followed further.
  bool add(const State& state) {
    ++looks_;
    const double now = static_cast<double>(looks_ * look_every_) * problem_->step;
    stable_ = judge_.is_good(state);
    if (!stable_) return false;
    gauge_.add(looks_ * look_every_, state);
    const double gap = distance_of_ball(*problem_, state);
    const bool touches = gap <= contact_distance;
    if (touches && !first_touch_) first_touch_ = now;
    // One particle's touch lifts it off at once; the ball has left when all of it rises.
    const bool off = gap >= start_gap && along(mean_velocity(state), normal_) > 0.0;
    if (!first_touch_ || !off) off_since_ = now;
    left_ = first_touch_ && now - off_since_ > 0.1 * (off_since_ - *first_touch_);
    end_ = now;
    return !left_;
  }
  // `good`: the trial's own verdict; a state that is not finite never comes to add().
  [[nodiscard]] BounceRun result(bool good) const {
    const bool stable = stable_ && (good || left_);
    return {stable, left_, end_, stable ? gauge_.result() : std::nullopt};
  }

 private:
  const Problem* problem_;
  Vec2 normal_;
  std::int64_t look_every_;
  EnergyJudge judge_;
  MarginGauge gauge_;
  std::int64_t looks_ = 0;
  bool stable_ = false, left_ = false;
  std::optional<double> first_touch_;   // s
  double off_since_ = 0.0, end_ = 0.0;  // s
};

}  // namespace

double meeting_speed(const Problem& problem) {
  if (problem.walls.empty()) return 0.0;
  const Wall& wall = nearest_wall(problem);
  const double approach = -along(mean_velocity(problem.initial), wall.normal);
  const double pull = -along(problem.gravity, wall.normal);
  const double gap = std::max(distance_of_ball(wall, problem.initial), 0.0);
  const double squared = approach * std::abs(approach) + 2.0 * pull * gap;
  // Thrown away from the wall it comes back as fast, if something pulls it back.
  if (approach < 0.0 && pull > 0.0) return std::sqrt(approach * approach + 2.0 * pull * gap);
  return squared > 0.0 ? std::sqrt(squared) : 0.0;
}

State just_above_wall(const Problem& problem, double speed) {
  const Wall& wall = nearest_wall(problem);
  State state = problem.initial;
  const double down = distance_of_ball(wall, state) - start_gap;
  for (double& x : state.x) x -= down * wall.normal.x;
  for (double& y : state.y) y -= down * wall.normal.y;
  const double change = -speed - along(mean_velocity(state), wall.normal);
  push(state, {change * wall.normal.x, change * wall.normal.y});
  return state;
}

std::vector<BounceRun> follow_bounces(std::span<const Problem> problems,
                                      std::span<const std::int64_t> steps, std::int64_t look_every,
                                      std::span<const double> growth, const TrialOptions& options) {
  std::vector<Follower> followers;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    followers.emplace_back(problems[i], growth[i], look_every);
  }
  // A bounce that is over ends its trial, too; the follower knows whether it was stable.
  const std::vector<bool> good = run_trials(
      problems, steps, look_every,
      [&](std::size_t i, const State& state) { return followers[i].add(state); }, options);
  std::vector<BounceRun> results(problems.size());
  parallel_for(problems.size(), options.threads,
               [&](std::size_t i) { results[i] = followers[i].result(good[i]); });
  return results;
}

}  // namespace bounce
