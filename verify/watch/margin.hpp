// How near a run comes to the edge of stability: its time step as a part of the largest stable one.
//
// The edge moves with the ball: a bond of the law (3, 5) that is pressed to half its length is 136
// times as stiff, and its stable step a twelfth. So each look at a run renews the bound of the
// fastest vibration, which costs about what measuring the energies costs, and the few states whose
// bound was the worst are kept. At the end Lanczos looks at these, worst bound first, until no
// state that was looked at can have been worse than the worst found: a bound below that rules a
// state out for certain.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "verify/vibrations/spectrum.hpp"

namespace bounce {

/// Time step / largest stable step of a method for vibrations up to `omega` (1/s).
double part_of_stable_step(const Problem& problem, double omega);

/// The greatest part of the stable step that a run used, of the states that were looked at.
struct Margin {
  double part = 0.0;      ///< step / stable step at the worst state found
  double at_most = 0.0;   ///< no state looked at used more than this; infinity if one had no bound
  bool exact = false;     ///< part is by Lanczos; else by the bound
  std::int64_t step = 0;  ///< of the worst state
  std::int64_t first = 0, second = 0;  ///< its stiffest bond: particles, from 0
  double ratio = 0.0;                  ///< R/R0 of that bond
};

/// Looks at the states of a run. Memory: at most eight states.
class MarginGauge {
 public:
  /// Refers to the problem, which has to outlive it.
  explicit MarginGauge(const Problem& problem);
  /// The part of the stable step that the step is at this state, by the bound; NaN if a stiffness
  /// there is not finite.
  double add(std::int64_t step, const State& state);
  /// Lets Lanczos work. Nothing if no state with a finite stiffness has been added.
  [[nodiscard]] std::optional<Margin> result() const;

  template <class Words>
  void serialize(Words& words) {
    words(worst_, dropped_);
  }

 private:
  struct Look {
    double part = 0.0;  // by the bound
    std::int64_t step = 0;
    StiffnessBound bound{};
    State state{};  // empty where the ball is too large to keep it
    template <class Words>
    void serialize(Words& words) {
      words(part, step, bound.lambda, bound.first, bound.second, bound.ratio, state);
    }
  };
  void keep(Look look, const State& state);

  const Problem* problem_;
  double limit_;             // of the method
  std::size_t room_;         // looks to keep
  std::vector<Look> worst_;  // falling part; of equal ones the first comes first
  double dropped_ = 0.0;     // largest part by the bound of the looks not kept
};

}  // namespace bounce
