#include "driver/scene/load_problem.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "driver/scene/state_file.hpp"

namespace bounce {
namespace {

// Four decimals move both ends of a bond by up to 5e-5 cm. The paper's shortest bond is 0.26 cm
// long: 0.04 % of it.
void check_rounding(const Scene& scene, const Problem& problem) {
  constexpr double moved = 1e-4, most = 0.01;
  double shortest = std::numeric_limits<double>::infinity();
  for (const BondClass& bond : problem.classes) shortest = std::min(shortest, bond.rest);
  if (scene.ball.rounding == Rounding::none || moved <= most * shortest) return;
  throw SceneError("ball.rounding", "\"listing\"",
                   fmt::format("\"none\": four decimals would strain bonds {:.3g} cm long by up to "
                               "{:.2g} %",
                               shortest, 100.0 * moved / shortest));
}

}  // namespace

std::optional<State> load_start(const std::string& initial) {
  if (initial.empty()) return std::nullopt;
  return read_state(initial).state;
}

Problem load_problem(const SceneFile& file, const std::optional<State>& start) {
  try {
    const Scene scene = file.scene();
    Problem problem = make_problem(scene, start);
    if (!start) check_rounding(scene, problem);
    return problem;
  } catch (const SceneError& error) {
    throw file.explain(error);
  }
}

}  // namespace bounce
