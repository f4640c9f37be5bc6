// Many scenes at once, one a vector lane: for sweeps over E, time step, walls, starts.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/plan.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// Independent problems of one shape (rings and bonds), law (p, q) and method; each has its own E,
/// gravity, time step, walls and start. Scenes wait in one queue for the next free lane, so each
/// may take a number of steps of its own.
///
/// A scene's bits are those of the kernel `ring`, whatever runs beside it, in any order, on any
/// number of threads. A scene that is found bad when it is looked at is retired: it goes back to
/// its last good state, and its lane takes the next scene.
class Ensemble {
 public:
  /// True if scene i may go on. Called by several threads, never for the same scene at once.
  using IsGood = std::function<bool(std::size_t i, const State&)>;

  /// How often a scene is looked at unless said otherwise, in its own steps from its start. That
  /// costs less than 1 %.
  static constexpr std::int64_t check_every = 2000;

  /// Uses vector target and threads of the request (0: one a core); its kernel name is not looked
  /// at. Throws PlanError naming the problem that is of another kind than the first, or why the
  /// ring kernels cannot run them.
  /// A state that is not finite is never good; `is_good` may demand more, each `look_every` steps
  /// and where advance() ends. Throws std::invalid_argument unless look_every > 0.
  explicit Ensemble(std::span<const Problem> problems, const PlanRequest& request = {},
                    IsGood is_good = {}, std::int64_t look_every = check_every);
  ~Ensemble();
  Ensemble(const Ensemble&) = delete;
  Ensemble& operator=(const Ensemble&) = delete;

  [[nodiscard]] std::size_t size() const;
  /// Lanes of a vector.
  [[nodiscard]] int lanes() const;
  [[nodiscard]] int threads() const;
  /// Scene i takes steps[i] steps, if it is not retired.
  void advance(std::span<const std::int64_t> steps);
  /// All scenes take the same number of steps.
  void advance(std::int64_t steps);
  /// Positions and velocities of scene i, all stages done.
  [[nodiscard]] State state(std::size_t i) const;
  [[nodiscard]] Snapshot save(std::size_t i) const;
  /// Also takes a retired scene back to work.
  void restore(std::size_t i, const Snapshot& snapshot);
  /// Steps that scene i has taken.
  [[nodiscard]] std::int64_t step(std::size_t i) const;
  [[nodiscard]] bool retired(std::size_t i) const;

 private:
  struct Member;
  class Worker;
  IsGood is_good_;
  std::int64_t look_every_;
  std::vector<Member> members_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace bounce
