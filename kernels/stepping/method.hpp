// Time-stepping methods as tables. A stage is a kick, v += kick dt a(x), then a drift,
// x += drift dt v, then the walls. One kernel runs them all; it never knows which method it runs.
//
// A method whose last stage does not drift (`first_same_as_last`) shares the force evaluation of
// that stage with the first stage of the next step: the kernel adds the two kicks and keeps the
// last one pending; a state that is read out is completed on a copy, so reading never changes a
// run.
#pragma once

#include <span>
#include <string_view>

namespace bounce {

/// v += kick dt a(x); x += drift dt v; walls. Only the last stage of a first-same-as-last method
/// has no drift (and so no walls).
struct Stage {
  double kick;
  double drift;
};

/// A method declares what its tests then measure.
struct Method {
  std::string_view name;
  std::string_view description;
  std::string_view source;
  std::span<const Stage> stages;
  int order;        ///< of the error of positions on smooth motion
  int evaluations;  ///< of the force, a step
  bool reversible;  ///< a step back (negative dt) undoes a step, but for rounding
  bool first_same_as_last;
};

/// All methods, in the order in which help lists them. Adding one adds a line here.
std::span<const Method> methods();

/// The method of that name, or null.
const Method* find_method(std::string_view name);

}  // namespace bounce
