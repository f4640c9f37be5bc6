// Before a run: is its time step below the largest one that is stable at its start?
#pragma once

#include <optional>
#include <string>

#include "driver/scene/scene_file.hpp"
#include "kernels/model/problem.hpp"
#include "verify/vibrations/spectrum.hpp"
#include "verify/watch/margin.hpp"

namespace bounce {

/// What the start allows.
struct StepCheck {
  FastestVibration fastest;
  double stable_step =
      0.0;            ///< of the scene's method at the start, s; infinity if nothing vibrates
  double part = 0.0;  ///< time step / stable step
};

/// Part of the stable step from which on a run is warned of: at one half the frequencies that a
/// second-order method gives the stiffest bonds are 5 % off, and an impact that presses such a bond
/// to 0.85 of its length takes it to the edge.
inline constexpr double part_to_warn_of = 0.5;

/// The check of a problem's start, or nothing if a stiffness there is not finite.
std::optional<StepCheck> check_step(const Problem& problem);

/// Throws InputError naming key, value, what is allowed and where the value came from, if the
/// start has no finite stiffness, the step is beyond the stable one, or something moves so fast,
/// at the start or when the ball will meet a wall, that it could pass through a neighbour or the
/// wall within a step.
void refuse_unstable_step(const SceneFile& file, const Problem& problem,
                          const std::optional<StepCheck>& check);

/// One line for people: stable step, and the part of it that the time step is.
std::string describe(const StepCheck& check, const Problem& problem);

/// What to warn of before a run; "" if there is nothing.
std::string warning_of(const StepCheck& check, const Scene& scene);

/// Motion that rounding positions may swallow before a run is warned of, cm: the last decimal of
/// the listing's frames. x + v dt is x where v dt is less than half a last place of x.
inline constexpr double lost_motion_to_warn_of = 1e-4;

/// The warning of that, by the positions of the start, or "".
std::string warning_of_lost_motion(const Problem& problem, const Scene& scene);

/// The same of what the run used at most: "0.0031 at t = 9.2 s (bond 12-13 at R/R0 = 0.61)".
std::string describe(const Margin& margin, double time);

}  // namespace bounce
