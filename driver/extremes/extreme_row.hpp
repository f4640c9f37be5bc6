// The rows of `bounce extremes`: scene files with a table [extreme] that says what is expected.
//
// Each is a file of driver/scenes/extremes/, built in; adding a row is adding its file. It is a
// scene like any other (bounce run extremes/NAME runs it, and leaves [extreme] alone), so what is
// not given has the defaults of Scene: the paper's ball, E = 16000, g = 0.098, no wall, 1e-6 s.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/scene/scene_file.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// The three good ends of a run.
enum class Outcome {
  complete,  ///< exit code 0, and its ledgers close
  refused,   ///< exit code 2, before it starts, nothing written
  stops,     ///< exit code 3: trouble named, last good state kept, and it can be run on
};
std::string name_of(Outcome outcome);

/// A row: its scene, and its table [extreme].
struct ExtremeRow {
  std::string name;  ///< of the file, without .toml
  std::string text;  ///< of the file
  Scene scene;
  std::string group;  ///< what is extreme: "elasticity", "impact", ...
  Outcome expected = Outcome::complete;
  std::string because;      ///< why that is expected
  std::string says;         ///< what the message must hold, of a row that is refused or stops
  bool quick = false;       ///< part of --quick
  bool force = false;       ///< run beyond the stable step, too (--force)
  std::int64_t booked = 0;  ///< steps to take once more with every reflection booked
  std::optional<double> first_bond;  ///< R/R0 at which bond 1-2 starts: particle 1 is moved
  std::string like;                  ///< the row that this one repeats at another place
};

/// Reads a row's text. Throws InputError naming row, key, value and what is allowed.
ExtremeRow read_extreme_row(const std::string& name, std::string_view text);

/// All rows built in, by group in the order of the table, then by name.
std::vector<ExtremeRow> extreme_rows();

/// The state the row starts from, if it is not the scene's own ball.
std::optional<State> start_of(const ExtremeRow& row);

}  // namespace bounce
