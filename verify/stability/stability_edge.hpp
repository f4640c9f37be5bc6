// The edge of stability, measured: the largest time step, or the largest E, with which a ball stays
// stable in free flight or through a bounce, beside what the stiffness of its bonds predicts.
//
// How it is measured
//  1. A run is called unstable by its energy (energy_judge.hpp). The edge is the place between a
//     stable and an unstable run, found by bisection until the two are no more than 1 % apart. The
//     prediction is only where the search begins: both ends are run.
//  2. Free flight is flight alone: no walls, no gravity, the ball's own velocity taken away. What
//     is left scales: E and dt enter as E dt^2.
//  3. Each start is disturbed by a millionth of the shortest bond, so that the fastest vibration is
//     there to grow. With a step that is a part d beyond the edge, leapfrog multiplies it by about
//     1 + sqrt(8 d) each step: at d = 0.1 % by 10^11 in a hundred periods. So the criterion hardly
//     matters; what another one would change stands in results/stability.md.
//  4. That holds for small vibrations. In larger ones the bonds' stiffness swings with the
//     vibration, and a step that is stable for each state it meets can still pump energy into it:
//     where a vibration takes three or four steps a period. For leapfrog that is at
//     omega dt = sqrt(3) and sqrt(2), 0.87 and 0.71 of its limit (Skeel, Zhang, Schlick, SIAM J.
//     Sci. Comput. 18 (1997) 203). EdgeCase::disturbance shows it in flight; a hard impact disturbs
//     enough by itself. Beyond such a place some steps are stable again: for these cases the lowest
//     edge is sought, from below.
//  5. Two predictions stand beside it. The strict one is the method's limit, the first place at
//     which any vibration grows, however slowly. The other is for the criterion itself: the first
//     place at which the fastest vibration, which has one (2 N - 3)th of the energy of a start
//     disturbed at random, grows within the periods to more than the factor times all of it. The
//     two are the same but for blanes-moan-4 and blanes-moan-6, whose first unstable window is
//     narrow (stability_limit.hpp).
//  6. Bisection steps over a narrow window, most likely, and what it finds then is the edge of the
//     next wide one. So a flight whose criterion a narrow window exceeds is sought by climbing
//     through that window in steps of half its width; only if all of them are stable, beyond it.
//     Beyond a wide window no flight is stable, as the vibrations of a ball stand so close that one
//     of them is in it. Through a bounce, or in large vibrations, narrow windows are not
//     climbed through: frequencies change with compression, and no vibration stays in one for long.
//     What bisection finds there is the edge of the wide window, or, of a ball that then lies still
//     for thousands of periods, one at or below which a vibration grew in a narrow one.
//  7. A bounce starts just above the wall and lasts as long as the same bounce took at a quarter of
//     the stable step (or less, where that is not stable), and a quarter more. The stiffest state
//     seen on that way gives the prediction.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/model/scene.hpp"
#include "verify/stability/trials.hpp"

namespace bounce {

/// What counts as unstable: more than `growth` times its energy gained within `periods` of the
/// fastest vibration (in a bounce: within the bounce), or a state that is not finite.
struct EdgeCriterion {
  double growth = 100.0;
  double periods = 1000.0;
};

/// The start's disturbance, in shortest bonds, unless it is what is asked about.
inline constexpr double edge_disturbance = 1e-6;

/// What the ball has to come through: free flight, or a whole bounce.
enum class Passage { flight, bounce };
/// The largest E is sought at the scene's time step, the largest time step at its E.
enum class Sought { step, elasticity };

/// One search for an edge.
struct EdgeCase {
  Scene scene;                   ///< with its method, E, gravity
  std::optional<State> initial;  ///< instead of the scene's own ball
  Passage passage = Passage::flight;
  Sought sought = Sought::step;
  double speed = 0.0;                     ///< of the impact, cm/s; 0: that of the scene's own fall
  double disturbance = edge_disturbance;  ///< of the start, in shortest bonds
  EdgeCriterion criterion{};
};

enum class EdgeOutcome {
  found,
  always_stable,    ///< no unstable run up to eight times the predicted edge of free flight
  always_unstable,  ///< no stable run down to 1/200 of it
  refused           ///< cannot be run: see why
};

/// An edge, in s or in units of E.
struct Edge {
  EdgeOutcome outcome = EdgeOutcome::refused;
  std::string why;        ///< of a refusal, one clause
  double stable = 0.0;    ///< the largest value found stable; 0 if none
  double unstable = 0.0;  ///< the smallest found unstable, at most 1 % above; infinite if none
  /// For the criterion, in a bounce from the running margin; 0 where there was nothing to predict
  /// from.
  double predicted = 0.0;
  double strict = 0.0;  ///< the same by the method's limit, by which bounce run warns and refuses
  double flight = 0.0;  ///< predicted for free flight of the same ball, as `predicted` is
  double used = 0.0;    ///< part of the stable step that the bounce at `stable` used at its worst
  double ratio = 0.0;   ///< R/R0 of the stiffest bond of the stiffest state of a bounce; else 0
  double speed = 0.0;   ///< of the impact, cm/s
  bool left = false;    ///< the ball left the wall; false for one that stays down, and in flight
  int runs = 0;
  std::int64_t steps = 0;  ///< of all runs, had none been cut short
};

/// Brackets are closed to this ratio.
inline constexpr double edge_ratio = 1.01;

/// A window of unstable steps is narrow, and could be stepped over, if its ends are within this.
inline constexpr double narrow_window = 1.02;

/// The periods after which the criterion's growth is exceeded in the first unstable window of the
/// scene's method, if that is narrow. Throws SceneError.
double periods_for_strict_limit(const Scene& scene, const std::optional<State>& initial,
                                double growth);

/// Measures edges of cases that differ in numbers alone (same method, law, rings), side by side.
/// The answers depend on neither threads nor on which cases are measured together. Nothing if
/// stopped.
std::optional<std::vector<Edge>> measure_edges(std::span<const EdgeCase> cases,
                                               const TrialOptions& options = {});

}  // namespace bounce
