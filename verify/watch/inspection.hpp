// What the ledgers need to know of a state beyond its energies and momenta (Sample): the modified
// energy that a method conserves, how fast and how near the walls the particles are, and how much
// one step may round.
//
// Modified energy. A step of kicks b dt and drifts c dt follows, but for higher orders of dt, the
// flow of
//
//     E + dt e (v.grad V) + dt^2 (f v.V''v + h |grad V|^2)                V: bonds and gravity
//
// whose coefficients e, f, h come from the method's own stages by the Baker-Campbell-Hausdorff
// formula (Hairer, Lubich, Wanner, Geometric Numerical Integration, III.4 and IX.4). The energy E
// itself comes and goes by the added terms: they are the swing of a run. What the modified energy
// changes by without a wall is drift, rounding, or the terms left out: of relative size (w dt)^3,
// or (w dt)^p for a method of order p > 3, whose e, f and h are zero.
#pragma once

#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "verify/watch/monitor.hpp"
#include "verify/watch/rounding_size.hpp"

namespace bounce {

/// Coefficients of the modified energy, without the powers of dt.
struct ModifiedEnergy {
  double first = 0.0;      ///< e, of v.grad V
  double stiffness = 0.0;  ///< f, of v.V''v
  double force = 0.0;      ///< h, of |grad V|^2
};

/// From the stages alone: (-1/2, 1/12, 1/12) for the listing, (0, 1/12, -1/24) for leapfrog, zeros
/// for a method of order 3 or more.
ModifiedEnergy modified_energy(const Method& method);

/// Roundings that one step may bring into each balance of the whole ball. They bound every kernel:
/// sums of a velocity, its neighbours' forces and gravity in any order; forces computed from both
/// ends, each with eight roundings on the size of its attraction and repulsion; one rounding of a
/// position.
struct StepRounding {
  RoundingSize momentum_x, momentum_y;  ///< cm/s
  RoundingSize angular;                 ///< about the centre of mass, cm^2/s
  RoundingSize energy;                  ///< erg

  template <class Words>
  void serialize(Words& words) {
    words(momentum_x, momentum_y, angular, energy);
  }
};

/// A state as a ledger sees it. Unit masses, cgs.
struct Inspection {
  double swing = 0.0;      ///< modified energy less energy, erg
  double internal = 0.0;   ///< kinetic energy about the centre of mass and elastic energy, erg
  double frequency = 0.0;  ///< no mode is stiffer, rad/s (row sums of the bonds' stiffness)
  double nearest = 0.0;    ///< least distance of a particle from a wall, cm; infinite without walls
  double behind = 0.0;     ///< greatest depth behind a wall, beyond what rounding explains, cm
  double fastest = 0.0;    ///< greatest speed of a particle, cm/s
  StepRounding step;
  RoundingSize angular, energy;  ///< of measuring the state itself

  template <class Words>
  void serialize(Words& words) {
    words(swing, internal, frequency, nearest, behind, fastest, step, angular, energy);
  }
};

/// Energy that the terms left out of the modified energy may come to, erg: their relative size, for
/// large steps that of the third order, times the internal energy. Their factors are below 1 up to
/// near the edge of stability (a test holds that).
double left_out(const Model& model, const Inspection& here);

/// `sample` as measure() gave it of this state.
Inspection inspect(const Model& model, const State& state, const Sample& sample);

}  // namespace bounce
