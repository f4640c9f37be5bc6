// What a run is watched by: energies, momenta and place of one state (a Sample), and the check that
// stops a run that has become unstable (a Watch).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kernels/model/problem.hpp"

namespace bounce {

/// One state, measured. Unit masses, cgs; energies are absolute (erg per unit mass).
struct Sample {
  double kinetic = 0.0;
  double bond = 0.0;     ///< sum of V(R) over all bonds
  double gravity = 0.0;  ///< -sum of g.x
  Vec2 momentum;
  double angular_momentum = 0.0;  ///< about the centre of mass
  Vec2 centre;                    ///< of mass, cm
  double lowest = 0.0;            ///< smallest y, cm
  double smallest_ratio = 0.0;    ///< smallest R/R0 of any bond; NaN if any is
  std::int64_t ratio_first = 0;   ///< particles of that bond, index from 0
  std::int64_t ratio_second = 0;
  double fastest_bond = 0.0;  ///< greatest |v_i - v_j| / R0 of a bond, 1/s; NaN if any is
  double approach = 0.0;      ///< greatest speed of a particle towards a wall, cm/s; NaN if any is
  std::int64_t on_wall = 0;   ///< particles nearer to a wall than contact_distance, or behind it

  [[nodiscard]] double total() const { return kinetic + bond + gravity; }

  template <class Words>
  void serialize(Words& words) {
    words(kinetic, bond, gravity, momentum.x, momentum.y, angular_momentum, centre.x, centre.y,
          lowest, smallest_ratio, ratio_first, ratio_second, fastest_bond, approach, on_wall);
  }
};

/// A particle nearer to a wall than this counts as touching it, cm: the last decimal of the
/// listing's frames. A particle held on a wall hovers within a_y dt^2, some 1e-9 cm.
inline constexpr double contact_distance = 1e-4;

/// Measures a state; sums are compensated (Neumaier), so each energy is good to its last digits.
Sample measure(const Problem& problem, const State& state);

/// How far a state moves in one drift of the problem's method, in parts of what it must not jump
/// over. Above 1 a particle could pass through its neighbour, or a wall by more than the distance
/// between neighbours, between two looks of the method at the forces.
struct Stride {
  double bond = 0.0;  ///< change of a bond, in its rest length
  double wall = 0.0;  ///< way towards a wall, in the shortest rest length
};
Stride stride_of(const Problem& problem, const Sample& sample);

/// Why a run is stopped; indices from 0, -1 where there is none.
struct Trouble {
  std::string what;  ///< one sentence without step and time; names particle and bond, from 1
  std::int64_t particle = -1;
  std::int64_t bond_first = -1, bond_second = -1;
};

/// Looks at a run from time to time. Walls only take energy and the scheme conserves it nearly, so
/// energy that appears from nowhere, more than the ball can ever set into motion, means
/// instability. What it can: its kinetic energy at the start, all that gravity can give, and ten
/// times its elastic energy at the start, because near the edge of stability the method itself
/// makes the energy of a vibration w swing by (1 + a)/(1 - a), a = w dt/2, without being unstable.
/// (Motion seen since must not count: in an unstable run it grows with the energy that it should
/// catch.) What gravity can give does not depend on when one looks: it is the fall of every
/// particle to the lowest place in front of the walls. Where there is no such place it is the
/// greatest fall seen.
class Watch {
 public:
  Watch(const Problem& problem, const State& start);
  /// The trouble with this state, if any. Never passes a NaN. Does not change the watch.
  [[nodiscard]] std::optional<Trouble> check(const State& state, const Sample& sample) const;
  /// Takes a good state's sample into account for later checks (where the fall has no end).
  void accept(const Sample& sample);
  /// Energy that may appear before the run counts as unstable, erg.
  [[nodiscard]] double allowed_gain() const { return allowed_gain(fall_); }

  template <class Words>
  void serialize(Words& words) {
    words(start_, motion_, floor_, fall_);
  }

 private:
  [[nodiscard]] double allowed_gain(double fall) const;

  const Problem* problem_;
  Sample start_;
  double motion_;      ///< kinetic energy and swing of the elastic energy at the start
  double floor_;       ///< energy that rounding may make
  double fall_ = 0.0;  ///< gravity energy: to the lowest place, or the most seen set free
};

}  // namespace bounce
