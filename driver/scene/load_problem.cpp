#include "driver/scene/load_problem.hpp"

#include <optional>

#include "driver/scene/state_file.hpp"

namespace bounce {

Problem load_problem(const SceneFile& file, const std::string& initial) {
  std::optional<State> start;
  if (!initial.empty()) start = read_state(initial);
  try {
    return make_problem(file.scene(), start);
  } catch (const SceneError& error) {
    throw file.explain(error);
  }
}

}  // namespace bounce
