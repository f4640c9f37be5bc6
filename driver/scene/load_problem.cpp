#include "driver/scene/load_problem.hpp"

#include "driver/scene/state_file.hpp"

namespace bounce {

std::optional<State> load_start(const std::string& initial) {
  if (initial.empty()) return std::nullopt;
  return read_state(initial);
}

Problem load_problem(const SceneFile& file, const std::optional<State>& start) {
  try {
    return make_problem(file.scene(), start);
  } catch (const SceneError& error) {
    throw file.explain(error);
  }
}

}  // namespace bounce
