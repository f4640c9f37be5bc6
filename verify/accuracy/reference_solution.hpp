// Two solutions of a scene that share neither method nor arithmetic; twice what they
// differ by is the error bar.
//
// What is solved is the model in continuous time: the motion under bonds and gravity, and the
// walls' rule in the limit of small steps. Particle by particle and wall by wall that is
//
//   free     reaches the wall (n.x = offset): its tangential velocity is multiplied by alpha, its
//            normal one by beta. With beta = 0 it then stays there if its normal acceleration a_n
//            (bonds and gravity) is not above 0; else it leaves at once.
//   resting  normal position fixed, normal velocity 0. With alpha < 1 it sticks: in the limit it
//            meets the wall again and again in no time, so nothing is left of its tangential
//            velocity. With alpha = 1 it slides freely. When a_n rises above 0, it is free.
//
// With beta below 0 a particle that is pressed on bounces ever lower. When its next bounce would be
// no higher than the roundings of a coordinate (ReferenceRun::height_cut) it counts as resting: no
// arithmetic could tell that bounce from none. The two solutions cut at different heights, so what
// the cut does is in their difference. beta = -1 keeps the height of such bounces, and the cut
// touches only what never rose.
//
// Not solved, and refused (ReferenceError): a particle that slides along one wall into another; a
// start behind a wall unless beta = -1 (the two contact rules put it in different places); a motion
// that no step can follow, as of a ball that collapses into points.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "kernels/contact/contact_run.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// What cannot be solved: one sentence.
using ReferenceError = ContactError;

/// "lands" ...
std::string_view name_of(ContactKind kind);

/// What a solution did.
using ReferenceRun = ContactRun;

/// Called at each output time with the state there (rounded to double). It may throw to stop.
using ReferenceVisitor = std::function<void(double time, const State& state)>;

/// Solution one: GSL's rk8pd (Prince and Dormand, order 8 with an estimate of its error), adaptive,
/// double precision.
struct AdaptiveSettings {
  /// Error allowed a step, in the ball's size (14 cm for the paper's); of velocities, in that times
  /// 1/128 of the angular frequency of the fastest vibration. Below 1e-14 it is the roundings of
  /// double precision that decide, and smaller steps make more of them.
  double tolerance = 1e-14;
};

/// Solution two: Blanes and Moan's symplectic Runge-Kutta-Nystroem method of order 6, SRKN_11^b,
/// fixed steps, x87's long double.
struct FixedSettings {
  double step = 0.0;  ///< s; 0: default_reference_step
};

/// Angular frequency of the fastest vibration at the start, 1/s; 0 if nothing vibrates. Throws
/// ReferenceError if a stiffness of the start is not finite.
double reference_frequency(const Problem& problem);

/// 1/8 of leapfrog's stable step at the start: 0.25 over reference_frequency. There the method's
/// error stays below the other solution's (Example 1, free flight to t = 1: 4e-13 cm). 1e-3 s for a
/// ball in which nothing vibrates.
double default_reference_step(const Problem& problem);

/// Throws std::invalid_argument unless the times are finite, not below 0 and increasing.
void check_output_times(std::span<const double> times);

/// Solves from problem.initial at time 0 to the last of `times` (s, not below 0, increasing), each
/// of which is a state handed to `visit`; `watch`, if any, sees each step. Events lie within some roundings of the time, or of what
/// decides them, of where they are; they are found in steps of the size of the ball's fastest
/// vibration, so a contact that begins and ends within one is found by its turning point. Throws
/// ReferenceError, std::invalid_argument for times or settings that cannot be, and whatever `visit`
/// throws.
ReferenceRun solve_adaptive(const Problem& problem, std::span<const double> times,
                            const AdaptiveSettings& settings, const ReferenceVisitor& visit,
                            ContactWatch* watch = nullptr);
ReferenceRun solve_fixed(const Problem& problem, std::span<const double> times,
                         const FixedSettings& settings, const ReferenceVisitor& visit,
                         ContactWatch* watch = nullptr);

/// The start moved: each coordinate of a particle by at most `size` (cm), evenly distributed and
/// always the same; not into a wall.
State disturbed_start(const Problem& problem, double size);

/// Largest distance between the two places of a particle, cm. NaN if one is not a number.
double largest_distance(const State& a, const State& b);

}  // namespace bounce
