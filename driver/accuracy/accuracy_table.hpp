// What bounce accuracy writes: accuracy.csv, and a table for a person.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "verify/accuracy/accuracy.hpp"

namespace bounce {

/// A row with its run time.
struct TimedRow {
  AccuracyRow row;
  double seconds = 0.0;  ///< of the whole course on one thread, without output
};

/// The paper's program beside them.
struct PapersProgram {
  std::optional<std::size_t> row;  ///< the listing's scheme and contact at 1e-6 s
  double seconds = 0.0;            ///< of the same steps by the oracle; 0: it cannot run the scene
};

/// "listing", "resolved" or, where the very time of a contact is found, "located".
std::string_view contact_name(const AccuracyRow& row);

/// The cheapest row that is no worse than the paper's program in any observable; nothing if there
/// is none, or that program went astray. Errors below the reference's bar count as the bar.
std::optional<std::size_t> cheapest_as_good(std::span<const TimedRow> rows,
                                            const PapersProgram& papers, const CourseErrors& bar);

/// The first row is the reference: its error bar and its values.
std::string accuracy_csv(std::span<const TimedRow> rows, const CourseRecord& reference,
                         const CourseErrors& bar);
std::string accuracy_table(std::span<const TimedRow> rows, const PapersProgram& papers,
                           const CourseRecord& reference, const CourseErrors& bar);

}  // namespace bounce
