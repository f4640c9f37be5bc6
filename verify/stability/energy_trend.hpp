// Does a method gain or lose energy in the long run? A ball without walls, many steps, and a
// straight line through its modified energy, the one that a method conserves (inspection.hpp).
#pragma once

#include <cstdint>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"
#include "verify/watch/ledger.hpp"

namespace bounce {

/// The trend of the modified energy in free flight.
struct EnergyTrend {
  double slope = 0.0;       ///< erg a step
  double half_width = 0.0;  ///< of its 95 % confidence interval, from the scatter about the line
  double rounding = 0.0;    ///< 95 %: the slope that a random walk of each step's roundings has
  std::int64_t steps = 0;
  LedgerReport ledger;  ///< momentum and angular momentum of the same flight

  /// Neither the scatter nor rounding explains the slope. Not a number counts as a trend.
  [[nodiscard]] bool any() const;
};

/// Takes the stepper `steps` steps on, in `batches` (at least 3) of `samples` samples each; the
/// line goes through the batches' means, which depend on each other less than samples do. The
/// problem must have no walls; throws std::invalid_argument otherwise.
EnergyTrend free_flight_trend(const Problem& problem, Stepper& stepper, std::int64_t steps,
                              int batches = 32, int samples = 32);

}  // namespace bounce
