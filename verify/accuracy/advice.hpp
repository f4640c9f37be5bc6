// Advice: the cheapest setting that reaches an asked error, found by running the scene.
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

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "verify/accuracy/accuracy.hpp"

namespace bounce {

struct AdviceRequest {
  Scene scene;
  std::optional<State> initial;
  double error = 0.0;                 ///< asked, in the unit of the observable
  std::string observable = "height";  ///< of observable_names, or "position"
  int threads = 0;                    ///< for the pilot; 0: one a core
  bool books = false;                 ///< the run will book every reflection: no located contact
  std::function<bool()> stop{};       ///< asked after each run; once true, there is no answer
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

/// Why there is no advice.
class NoAdvice : public std::runtime_error {
 public:
  enum class Why {
    nothing_vibrates,  ///< no step is too large
    not_known,         ///< the run does not have the observable
    not_reached,       ///< no setting reaches the error; see `smallest`
  };
  explicit NoAdvice(Why reason, double least = 0.0)
      : std::runtime_error("no setting can be advised"), why(reason), smallest(least) {}
  Why why;
  double smallest;  ///< error that something is known to reach
};

/// Whether advice can be asked about it: a name of observable_names, or "position".
bool is_observable(const std::string& name);
/// Its unit.
std::string unit_of(const std::string& observable);

/// Nothing if it was stopped. Throws NoAdvice; std::invalid_argument for an observable that does
/// not exist or an error that is not above 0.
std::optional<Advice> advise(const AdviceRequest& request);

}  // namespace bounce
