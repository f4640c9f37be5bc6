// Time-stepping methods as tables. A stage is a kick, v += kick dt a(x), then a drift,
// x += drift dt v, then the walls. A kernel runs the stages of any table; it never knows which
// method that is.
//
// A first-same-as-last method ends a step with what it begins one with: a kick (its last stage does
// not drift), or a drift (its first stage does not kick). Between two steps its last stage is held
// over and joined to the first one of the next step:
//
//                        end of a step   | begin of the next         held       joined
//     kick to kick     (b, c) (b1, 0)  | (b1, c1) (b2, c2) ...       (b1, 0)    (2 b1, c1)
//     drift to drift   (b, c) (b1, c1) | (0, c1) (b1, c2) ...        (b1, c1)   (b1, 2 c1)
//
// So a step costs one pass over the ball less than it has stages, and none of its passes is without
// force, but for the very first stage of a run that begins with a drift. What is read out is
// completed on a copy: the stage held over is done there. So neither reading nor a restart changes
// a run.
//
// Not taken: to hold a drift alone, with its kick done. A kernel kicks and drifts in one pass, so
// each call of advance() would end with a stage without drift, which meets the walls once more
// where a particle stands right on one, and begin with one without kick, which costs a pass.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace bounce {

/// v += kick dt a(x); x += drift dt v; walls. A stage without drift has no walls either.
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
  int order;                ///< of the error of positions on smooth motion
  int evaluations;          ///< of the force, a step
  bool reversible;          ///< a step back (negative dt) undoes a step, but for rounding
  bool first_same_as_last;  ///< the last stage is held over and joined to the next step's first
};

/// The stages as they are run, the same number in both.
struct StageSequence {
  std::vector<Stage> fresh;   ///< of a step for which no stage is held over
  std::vector<Stage> joined;  ///< of one that takes over the stage held; empty: none ever is
};
StageSequence stage_sequence(const Method& method);

/// All methods, in the order in which help lists them. Adding one adds a line here.
std::span<const Method> methods();

/// The method of that name, or null.
const Method* find_method(std::string_view name);

}  // namespace bounce
