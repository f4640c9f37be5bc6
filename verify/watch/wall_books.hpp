// What the walls did to the ball, added up reflection by reflection.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/model/scene.hpp"
#include "verify/watch/compensated_sum.hpp"
#include "verify/watch/rounding_size.hpp"

namespace bounce {

/// One wall's reflections since the start. Energies are changes of the ball's own, erg: what the
/// wall took is negative.
struct WallBook {
  std::int64_t reflections = 0;
  CompensatedSum kinetic, gravity, bond;
  CompensatedSum impulse_x, impulse_y;  ///< cm/s (unit masses)
  CompensatedSum torque;                ///< change of the angular momentum about the centre of mass

  template <class Words>
  void serialize(Words& words) {
    words(reflections, kinetic, gravity, bond, impulse_x, impulse_y, torque);
  }
};

/// The books of a run. Everything is a sum over the steps since the start.
struct WallBooks {
  std::vector<WallBook> walls;  ///< one a wall of the problem
  /// Energy from the end of one reflecting stage to the beginning of the next, measured on the
  /// whole ball: what the integrator did. Up to the last reflection; energy() is the energy then.
  CompensatedSum integrator;
  double energy = 0.0;
  RoundingSize energy_rounding;    ///< of the energies that `integrator` is made of
  RoundingSize momentum_rounding;  ///< of the booked impulses, each component
  RoundingSize torque_rounding;
  std::int64_t missed = 0;        ///< particles behind a wall that were not mirrored
  std::int64_t otherwise = 0;     ///< particles changed otherwise than the wall rule says
  std::int64_t first_fault = -1;  ///< the step of the first of those; -1: none
  /// Some reflections are those of a step finished on a copy (booking_stepper.hpp); the run will do
  /// them once more, otherwise.
  bool unfinished = false;

  [[nodiscard]] std::int64_t reflections() const;
  /// Energy that the ball got from all walls, erg.
  [[nodiscard]] double energy_given() const;
  [[nodiscard]] Vec2 impulse() const;
  [[nodiscard]] double torque() const;

  template <class Words>
  void serialize(Words& words) {
    words(walls, integrator, energy, energy_rounding, momentum_rounding, torque_rounding, missed,
          otherwise, first_fault, unfinished);
  }
};

}  // namespace bounce
