// The figures of a bounce (bounce.hpp) of a run, found while a kernel makes it.
//
//  1. It looks at the run at a cadence of its own, in whole steps (look_interval), whatever the run
//     writes and when. So the figures have the same bits for any output.monitor_every.
//  2. It keeps the states of the last looks, of the intervals with the last acts and of those that
//     may hold an extreme, and can go back to them with steppers of its own (ActFinder): to find the
//     first and the last act of an impact to a small part of a step, and extremes to roundings or to
//     what steps a sixteenth as long, from the step before on, tell.
//  3. Which walls act in an interval: none that no particle can reach (twice the greatest speed seen
//     at both ends, and the way of gravity), as long as gravity explains the change of momentum. One
//     wall in reach and momentum that gravity does not explain: that one. Else the interval is taken
//     once more, without the wall.
//  4. Whether the ball came back between two acts, and so a new impact begins, is decided where the
//     centre's speed at the looks leaves it open; a few intervals of a course.
//
// A ball of many particles (most_kept_particles) is looked at, too, but no state is kept: what would
// be found by going back is as good as the looks are close, and found_to says so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "kernels/plan/plan.hpp"
#include "kernels/stepping/stepper.hpp"
#include "verify/figures/act_finder.hpp"
#include "verify/figures/bounce.hpp"

namespace bounce {

/// Makes the kernel of a plan for other problems: the same bits, on one thread.
ActFinder::Make remake(const Plan& plan);

inline constexpr std::size_t most_kept_particles = 20'000;

class BounceGauge {
 public:
  /// `time_step`: the nominal one, s, that times are said in. `make`: makes the run's kernel;
  /// empty: nothing can be looked at again.
  BounceGauge(const Problem& problem, double time_step, ActFinder::Make make);

  /// Steps between two looks.
  [[nodiscard]] std::int64_t look_steps() const { return look_steps_; }
  /// True at the steps of its looks. (The start and the end of a run are looked at in any case.)
  [[nodiscard]] bool due(std::int64_t step) const { return step % look_steps_ == 0; }
  /// The next such step.
  [[nodiscard]] std::int64_t next(std::int64_t step) const {
    return (step / look_steps_ + 1) * look_steps_;
  }
  /// A look; a step that has been looked at, or a state that is not finite, is passed over, and so
  /// is all after the latter.
  void look(const Stepper& stepper);
  void look(std::int64_t step, const State& state, KeptState kept = {});

  /// When a wall first acted, s, of what has been looked at; nothing: not yet.
  [[nodiscard]] std::optional<double> first_contact() const;
  /// The step of the last look.
  [[nodiscard]] std::int64_t last_step() const { return last_ ? last_->step : -1; }
  /// Up to the last look.
  [[nodiscard]] Bounce result() const;

  /// All but what is made again from problem, time step and kernel.
  template <class Words>
  void serialize(Words& words) {
    words(last_, walls_, over_, extremes_, ended_);
  }

 private:
  struct Look {
    std::int64_t step = 0;
    BallLook ball;
    KeptState kept;
    template <class Words>
    void serialize(Words& words) {
      words(step, ball, kept);
    }
  };
  struct Interval {
    std::int64_t from = 0, to = 0;  // steps
    KeptState start;
    Vec2 velocity_before, velocity_after;  // of the centre, at both ends
    [[nodiscard]] std::int64_t steps() const { return to - from; }
    template <class Words>
    void serialize(Words& words) {
      words(from, to, start, velocity_before.x, velocity_before.y, velocity_after.x,
            velocity_after.y);
    }
  };
  // The impact that a wall is in, or was in last.
  struct OpenImpact {
    WallAct first;
    Interval last;  // the last interval in which the wall acted
    template <class Words>
    void serialize(Words& words) {
      words(first, last);
    }
  };

  [[nodiscard]] double time(std::int64_t step) const {
    return static_cast<double>(step) * time_step_;
  }
  [[nodiscard]] ActFinder* finder(const KeptState& start) const;
  [[nodiscard]] std::vector<std::size_t> acting(const Interval& interval, const BallLook& before,
                                                const BallLook& now) const;
  void add_act(std::size_t wall, const Interval& interval);
  [[nodiscard]] bool may_have_come_back(std::size_t wall, const Interval& before,
                                        const Interval& now) const;
  [[nodiscard]] WallAct first_act(const Interval& interval, std::size_t wall) const;
  [[nodiscard]] WallAct last_act(const Interval& interval, std::size_t wall) const;

  std::shared_ptr<const Model> model_;
  double time_step_;
  double least_flight_;
  std::int64_t look_steps_;
  std::shared_ptr<ActFinder> finder_;  // has no course of its own; copies of a gauge may share it
  std::optional<Look> last_;
  std::vector<std::optional<OpenImpact>> walls_;
  std::vector<Impact> over_;
  Extremes extremes_;
  bool ended_ = false;
};

}  // namespace bounce
