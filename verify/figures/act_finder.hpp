// When a wall acts on a ball: strikes one of its particles, or holds it.
//
//  1. The same kernel without that wall gives the same bits as long as the wall does not act (tests
//     hold that for every kernel), so the first and the last step in which it acts are found by
//     bisection, whatever the method and the rule of contact do within a step. A kernel that locates
//     contacts says itself when they are (Stepper::report_walls).
//  2. Within the step, a particle that comes from above the wall strikes it where the cubic through
//     its distance and speed before the step and after it, without the wall, is 0. One that the wall
//     has held is released when its acceleration along the normal rises through 0, which is found
//     between the steps on both sides of that. Both are good to the second order of the step, or the
//     order of the method if that is lower.
//
// Its steppers are its own, so that those of a run are left alone: they are made when first needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "kernels/contact/bond_forces.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// An act, and how the ball's centre moves just before it (the first of an impact) or just after it
/// (the last one).
struct WallAct {
  double time = 0.0;      ///< s
  double found_to = 0.0;  ///< s
  Vec2 velocity;          ///< cm/s
  template <class Words>
  void serialize(Words& words) {
    words(time, found_to, velocity.x, velocity.y);
  }
};

class ActFinder {
 public:
  /// Makes the kernel of a run for a problem: this one, also without one of its walls.
  using Make = std::function<std::unique_ptr<Stepper>(const Problem&)>;

  /// `time_step`: the nominal one, s, that times are said in.
  ActFinder(Problem problem, double time_step, Make make);

  /// Whether the wall acts within the steps after a state.
  bool acts(const Snapshot& from, std::int64_t steps, std::size_t wall);
  /// Its first and its last act within them; nothing if it does not act.
  std::optional<WallAct> first_act(const Snapshot& from, std::int64_t steps, std::size_t wall);
  std::optional<WallAct> last_act(const Snapshot& from, std::int64_t steps, std::size_t wall);

  /// The course `steps` further on.
  struct Place {
    Snapshot snapshot;
    State state;  ///< all stages done
  };
  Place go(const Snapshot& from, std::int64_t steps);
  /// The state some parts of a step on, of parts_of_step, which are steps of the same method.
  State part_of_step(const State& start, std::int64_t parts);
  static constexpr std::int64_t parts_of_step = 16;

  /// s after the start of a step.
  struct Within {
    double time, found_to;
  };

 private:
  enum class Which { first, last };
  Stepper& with_walls();
  Stepper& without(std::size_t wall);
  bool reports();
  [[nodiscard]] std::vector<WallReport> reports_of(const Snapshot& from, std::int64_t steps,
                                                   std::size_t wall);
  // The snapshot before the step with the first or last act.
  std::optional<Snapshot> before_first(const Snapshot& from, std::int64_t steps, std::size_t wall);
  std::optional<Snapshot> before_last(const Snapshot& from, std::int64_t steps, std::size_t wall);
  Within within_step(const Snapshot& before, std::size_t wall, Which which);
  std::optional<Within> release(std::size_t particle, std::size_t wall, const Snapshot& before,
                                Pull<double> pull);
  WallAct act_at(const Snapshot& before, const Within& within, Which which);
  [[nodiscard]] Pull<double> pull_on(std::size_t particle, std::size_t wall,
                                     const State& state) const;

  Problem problem_;
  double time_step_;
  Make make_;
  BondForces<double> forces_;
  std::unique_ptr<Stepper> with_, fine_;
  std::vector<std::unique_ptr<Stepper>> without_;  // of each wall
  bool reports_ = false;
  std::vector<WallReport> reported_;
};

}  // namespace bounce
