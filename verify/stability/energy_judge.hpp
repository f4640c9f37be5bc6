// The criterion of instability that the edge is measured by.
#pragma once

#include "kernels/model/problem.hpp"

namespace bounce {

/// Calls a run unstable when its ball has gained more energy than `growth` times what it had to
/// begin with: motion, elastic energy, and what it has fallen since. Walls take energy and give
/// none, so in exact arithmetic nothing is ever gained; a method makes the energy of a vibration
/// swing, near its limit by a factor of some hundred, and beyond it grow without end. A state that
/// is not finite is unstable. May be used by several threads.
class EnergyJudge {
 public:
  EnergyJudge(const Problem& problem, double growth);
  [[nodiscard]] bool is_good(const State& state) const;

 private:
  struct Energies {
    double own = 0.0;      // motion and bonds, erg
    double gravity = 0.0;  // erg
  };
  [[nodiscard]] Energies energies(const State& state) const;

  const Problem* problem_;  // has to outlive this
  double growth_;
  Energies start_;
};

}  // namespace bounce
