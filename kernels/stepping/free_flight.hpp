// Free flight: for how many steps no particle can reach a wall, so that the wall test may be left
// out. The bits are those of a run with the test, as it would not have found anything.
//
// The bound. A step is stages v += b a, x += c v with b, c = kick dt, drift dt; let B, C be the
// sums of |b|, |c| over a step, x0, v0 the state at the start, V any velocity.
//
//  1. What all particles share bends no bond. Let w, m move like a particle that starts at the
//     velocity V and feels gravity alone, m from 0 on. After n steps |w| <= |V| + n B |g| and
//     |m| <= n C (|V| + n B |g|).
//  2. Let u = x - x0 - m and y = v - w be what a particle does beside that, U and Y the largest |u|
//     and |y| of any particle at any stage so far. Bonds alone drive them: a stage is y += b p,
//     u += c y with p the sum of the bonds' forces.
//  3. A bond's length changes by at most 2 U. While U <= most, the bonds of a class are no shorter
//     than r = (their shortest at the start, R0 at most) - 2 most. From there on the stiffness
//     S = -F' stays within -K .. K, K being the larger of S(r) and -S(R*): S falls up to R*, where
//     S' = 0, and beyond stays below zero and above S(R*). So |F| <= |F(R0)| + K (strain at the
//     start + 2 U), and with the sums over a particle's bonds, largest of any particle,
//
//         |p| <= a + k U,     a = sum |F(R0)| + K strain,     k = sum 2 K.
//
//  4. Whatever the number, order and sign of the stages: U and Y grow monotonically within a step,
//     so with their values at its end (primes)
//
//         Y' <= Y + B (a + k U'),   U' <= U + C Y'.
//
//     With q = U + a/k, h = sqrt(C / (B k)) and t = sqrt(B C k) that is
//
//         h Y' <= h Y + t q',       q' <= q + t h Y'.
//
//     For t < 1 the matrix (1, -t; -t, 1) has an inverse without negative entries, so q and h Y
//     stay below the solution of the equations:
//
//         q_n = (q_0 + h Y_0)/2 (1 - t)^-n + (q_0 - h Y_0)/2 (1 + t)^-n,   U_n <= q_n - a/k.
//
//  5. So if q_n - a/k <= most, 3 holds at all stages of n steps, by induction: each kick uses the U
//     before it. And if |m| + most is less than the distance from the walls, nobody reaches one.
//
// Rounding. Each step adds at most e to U and f to Y: the stored position is off by half an ULP,
// the velocity by half an ULP for each number added to it. Both stay below 1e-15 of the largest
// numbers that can occur, per stage and number. Since the inverse of 4 is nowhere below 1, n steps
// of that are covered by adding n e and n f at the start. A force is off by at most 1e-12 of what
// attraction and repulsion are one by one (some ten roundings, times the exponent, below 1e-14):
// that goes into a. So does the sum of a particle on the axis of `mirror`, which is put to zero. A
// wall distance is off by 1e-14 of the numbers it is made of. The bound itself is computed to 1e-11
// (n roundings in the powers); a part 1e-9 is added. Bonds outside 1e-12 .. 1e12 cm are not looked
// at: within, no product of four squares leaves the range of a double.
//
// V is the middle of the velocities. most is chosen so that r^-(q+1) grows by e^(1/2) (with more, t
// grows faster than the logarithm of most), or half the distance from the wall if that is less. At
// E = 16000 and dt = 1e-6 s windows are 400 to 1000 steps, at E = 1000 four times that.
//
// Who uses it: the walks ring_loop and mirror_half, alone or in a team, and csr, between whose
// slices the test stands anyway. Gain, far from a floor and from two walls, AVX2 on Zen 3: ring 3
// and 27 %, mirror 4 and 25 %, csr 10 and 11 %, two threads on mirror 4 %; where a wall is near,
// asking takes less than half a per cent (bench/left_out.cpp). Not used: ring_tiles (large balls; a
// survey of all of it by one thread, and its sweeps wait for memory), rings, the ensemble (a lane
// near its wall would hold up the others), strict (it is the listing).
//
// Not taken: the energy (a symplectic method cannot squeeze a bond with more than the ball has:
// windows are longer, but the proof is one a method, and a large ball has too much energy); the
// plain sum V T + A T^2 (windows five times shorter).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "kernels/model/problem.hpp"

namespace bounce {

/// The least and the greatest of some numbers.
struct Span {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (value < least) least = value;
    if (value > greatest) greatest = value;
  }
  void add(Span other) {
    add(other.least);
    add(other.greatest);
  }
};

/// What free flight must know of a state.
struct FlightSurvey {
  std::vector<Span> r2;  ///< by class: squared lengths of its bonds, cm^2
  Span vx, vy;           ///< cm/s
  double reach = 0.0;    ///< largest |x| or |y|, cm
  double gap = 0.0;      ///< smallest distance from a wall, cm
  bool finite = false;   ///< all positions and velocities are numbers
};

/// The bound for one problem's walls, bonds, law and step.
class FreeFlight {
 public:
  explicit FreeFlight(const Model& model);

  struct Window {
    std::int64_t steps = 0;  ///< 0, or at least fewest_steps
    double departure = 0.0;  ///< `most`: no particle departs further from the common motion, cm
  };
  /// For how many steps nobody reaches a wall.
  [[nodiscard]] Window window(const FlightSurvey& survey) const;

  /// An empty survey, for one pass over the particles.
  [[nodiscard]] FlightSurvey nothing_seen() const {
    FlightSurvey survey;
    survey.r2.resize(classes_.size());
    return survey;
  }

  static constexpr std::int64_t fewest_steps = 128;    // fewer do not pay for the survey
  static constexpr std::int64_t most_steps = 1 << 16;  // rounding is counted for so many

 private:
  // A class of bonds: what does not depend on the state.
  struct Bond {
    BondClass law;
    double at_rest = 0.0;   // |F(R0)|
    double steepest = 0.0;  // -S(R*), g/s^2
  };
  // Particles with the same classes of bonds.
  using Kind = std::vector<std::size_t>;
  // a, k and the numbers made of them.
  struct Rates {
    double a_over_k = 0.0, h = 0.0, t = 0.0;
  };

  void find_kinds(const Neighbours& bonds);
  [[nodiscard]] Rates rates(const FlightSurvey& survey, double most) const;

  PairLaw law_;
  std::vector<Bond> classes_;
  std::vector<Kind> kinds_;
  double longest_row_ = 0.0;
  double gravity_ = 0.0, farthest_offset_ = 0.0;
  double kicks_ = 0.0, drifts_ = 0.0, stages_ = 0.0;  // B, C and the stages of a step
};

/// Deals out steps: with the wall test, or, where the bound allows, without. What is left of a
/// window serves the next call.
class FlightTurns {
 public:
  explicit FlightTurns(const Model& model) : flight_(model) {}

  /// Calls step(n, free) until `steps` steps are taken; survey(FlightSurvey&) looks at the present
  /// state.
  template <class Survey, class Step>
  void advance(std::int64_t steps, const Survey& survey, const Step& step) {
    while (steps > 0) {
      if (left_ == 0 && steps < steps_worth_a_survey) return step(steps, false);
      if (left_ == 0) {
        FlightSurvey seen = flight_.nothing_seen();
        survey(seen);
        left_ = flight_.window(seen).steps;
        free_ = left_ > 0;
        if (!free_) left_ = steps_at_a_wall;
      }
      const std::int64_t n = steps < left_ ? steps : left_;
      step(n, free_);
      steps -= n;
      left_ -= n;
    }
  }

  /// The state has been replaced.
  void forget() { left_ = 0; }

 private:
  // With a wall near, the next survey comes after so many steps: it takes 0.2 % of them.
  static constexpr std::int64_t steps_at_a_wall = 512;

  // For one step at a time, far from any other, nothing is surveyed.
  static constexpr std::int64_t steps_worth_a_survey = 16;

  FreeFlight flight_;
  std::int64_t left_ = 0;
  bool free_ = false;
};

}  // namespace bounce
