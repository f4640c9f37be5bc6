// The table of `bounce extremes`, as text, Markdown and CSV.
#pragma once

#include <string>
#include <vector>

#include "driver/extremes/extreme_row.hpp"
#include "driver/extremes/extreme_run.hpp"

namespace bounce {

/// A row and what happened to it.
struct ExtremeEntry {
  ExtremeRow row;
  ExtremeResult result;
};

/// One line for people: "ok  bond-short  refused: ...".
std::string line_of(const ExtremeEntry& entry);

/// With a heading, how many are as expected, and the origin. Entries in the order given.
std::string extremes_markdown(const std::vector<ExtremeEntry>& entries, const std::string& command);

/// Header and one line a row; text in quotes.
std::string extremes_csv(const std::vector<ExtremeEntry>& entries);

}  // namespace bounce
