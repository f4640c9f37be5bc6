// One row of `bounce extremes`, run as a user runs it: by `bounce run`, in a process of its own,
// judged by its exit code and by the files it leaves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "driver/extremes/extreme_row.hpp"

namespace bounce {

/// What happened to a row.
struct ExtremeResult {
  std::string happened;  ///< "complete", "refused", "stops"; or, always a fault, "fails"
  bool as_expected = false;
  int exit_code = 0;  ///< -1: none, it was killed
  std::int64_t steps = 0;
  std::optional<double> greatest_part;  ///< of the stable step that was used
  std::string detail;                   ///< what a reader wants to know, or what is wrong; one line
  State last{};                         ///< of a row that is compared with another one

  template <class Words>
  void serialize(Words& words) {
    words(happened, as_expected, exit_code, steps, greatest_part, detail, last);
  }
};

/// Runs the row in `folder`, in files that bear its name, which must not exist. Files stay.
/// `is_compared`: a complete row's last state is wanted.
ExtremeResult run_extreme_row(const ExtremeRow& row, const std::filesystem::path& folder,
                              bool is_compared);

/// For a complete row that is `like` another complete one: says how far their ends are apart, and
/// what roundings of the positions explain. Not as expected if that is less.
void compare_with_like(const ExtremeRow& row, const ExtremeRow& like, const State& like_last,
                       ExtremeResult& result);

}  // namespace bounce
