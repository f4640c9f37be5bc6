// States on disk: the final state as CSV, and initial states in either format.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "driver/world/files.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// A state as a file has it.
struct FiledState {
  State state;
  /// The same before the stage that its method holds over from step to step (method.hpp): what a
  /// run goes on from to the bit.
  std::optional<State> held;
};

/// CSV with header i,x,y,vx,vy (cm, cm/s): particles in the listing's numbering from 1, 17
/// significant digits, so that reading it back gives the same bits. With a held state four more
/// columns: held_x,held_y,held_vx,held_vy.
void write_state_csv(OutputFile& file, const State& state,
                     const std::optional<State>& held = std::nullopt);

/// Reads that CSV, or the listing's format: x, y, vx, vy as 4F12.4, one particle a line. Throws
/// InputError naming file, line and what is allowed.
FiledState read_state(const std::string& path);
/// The same of a text that is there already; messages call it `name`.
FiledState parse_state(std::string_view text, const std::string& name);

}  // namespace bounce
