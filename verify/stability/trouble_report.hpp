// The report on a run that has become unstable: the two states on either side of the first step
// that was refused, the bond in question, the energy, and how far the time step was from the edge.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kernels/model/problem.hpp"
#include "verify/watch/margin.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {

/// How far a state is from the edge of stability.
struct EdgeDistance {
  double part = 0.0;         ///< time step / stable step
  double stable_step = 0.0;  ///< s; infinity if nothing vibrates
};

/// One state, as the report looks at it. NaN and infinity are reported as they are.
struct TroubledState {
  double energy = 0.0;               ///< kinetic, bond and gravity, erg
  double ratio = 0.0;                ///< R/R0 of the trouble's bond
  std::optional<EdgeDistance> edge;  ///< nothing: a stiffness there is not finite
};

struct TroubleReport {
  std::string bond_class;               ///< "ring 1-ring 2"; "" if the trouble names no bond
  std::optional<TroubledState> before;  ///< the last good state; nothing: the start was refused
  TroubledState refused;
  /// A time step to try, s: `step_safety` times the smallest stable step of the good states known,
  /// at most half of the one that failed, rounded down to two digits. So whoever follows it comes
  /// to a step that does. Refused states do not count: an instability presses bonds as no stable
  /// run does. Nothing if no good state has a finite stable step.
  std::optional<double> stable_step;

  /// Energy that came up in the refused step, erg; of a refused start, NaN.
  [[nodiscard]] double energy_jump() const;
};

/// Part of the smallest stable step known that a report proposes. The states between those looked
/// at may be stiffer, and near the edge a method's own error is large: a half keeps the frequency
/// of the stiffest bond within 5 %.
inline constexpr double step_safety = 0.5;

/// `before`: the last good state, or null if the start was refused. `margin`: of the states looked
/// at before; nothing if there are none.
TroubleReport report_trouble(const Problem& problem, const Trouble& trouble, const State* before,
                             const State& refused, const std::optional<Margin>& margin);

}  // namespace bounce
