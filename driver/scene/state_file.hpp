// States on disk: the final state as CSV, and initial states in either format.
#pragma once

#include <string>
#include <string_view>

#include "driver/world/files.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// CSV with header i,x,y,vx,vy (cm, cm/s): particles in the listing's numbering from 1, 17
/// significant digits, so that reading it back gives the same bits.
void write_state_csv(OutputFile& file, const State& state);

/// Reads that CSV, or the listing's format: x, y, vx, vy as 4F12.4, one particle a line. Throws
/// InputError naming file, line and what is allowed.
State read_state(const std::string& path);
/// The same of a text that is there already; messages call it `name`.
State parse_state(std::string_view text, const std::string& name);

}  // namespace bounce
