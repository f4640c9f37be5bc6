// bounce advise: the cheapest setting that reaches an asked error, found by running the scene.
//
// Runs are so cheap here (a whole course of the paper's in some 0.01 s at the largest steps) that
// nothing need be extrapolated:
//  1. Two fine courses are the pilot's own reference: with located contact, by the method of the
//     highest order. How well it is known is what they differ by, or what a third one does from a
//     start some roundings away. Where a small disturbance grows large, in a collapse or a long
//     contact, that is much.
//  2. The scene is run by each method, contact resolved and located, from the largest stable steps
//     down; the error forecast for a setting is its measured distance from the pilot's reference.
//  3. Run times are measured by turns on the kernel that will run it.
//  4. Where no setting reaches the error, all steps and those of the pilot are made smaller by a
//     factor 3; where the pilot's reference is not known well enough, its own first. If it then
//     knows no better, nothing would help: refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "driver/accuracy/accuracy_table.hpp"
#include "verify/accuracy/accuracy.hpp"

namespace bounce {

struct AdviceRequest {
  Scene scene;
  std::optional<State> initial;
  double error = 0.0;                 ///< asked, in the unit of the observable
  std::string observable = "height";  ///< of observable_names, or "position"
  int threads = 0;                    ///< for the pilot; 0: one a core
  bool books = false;                 ///< the run will book every reflection: no located contact
};

struct Advice {
  Setting setting;
  double step = 0.0;      ///< s, as to be written to time.step
  double error = 0.0;     ///< forecast, not below `known_to`
  double seconds = 0.0;   ///< forecast of the run on one thread, without output
  double known_to = 0.0;  ///< how well the pilot knows the course
  std::string unit;
  double pilot_seconds = 0.0;
  std::size_t courses = 0;  ///< run by the pilot
};

/// Throws InputError for an observable that does not exist or that the course does not have, an
/// error that is not above 0, a scene in which nothing vibrates, or an error that nothing reaches,
/// with the smallest that something does. Nothing if it was interrupted.
std::optional<Advice> advise(const AdviceRequest& request);

/// The advice and its forecasts, for a person: some lines, without an end of line.
std::string describe(const Advice& advice, const AdviceRequest& request);

/// The advice as keys and values of the scene: "time.step=0.001" and so on.
std::vector<std::string> settings_of(const Advice& advice, const Scene& scene);

}  // namespace bounce
