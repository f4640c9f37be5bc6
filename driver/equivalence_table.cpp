#include "driver/equivalence_table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace bounce {
namespace {

constexpr const char* columns = "{:<23} {:<7} {:<34} {:<38} {:<22} {}\n";

std::ptrdiff_t rows_that_hold(const std::vector<EquivalenceRow>& rows) {
  return std::count_if(rows.begin(), rows.end(),
                       [](const EquivalenceRow& row) { return row.pass; });
}

}  // namespace

std::string equivalence_table(const std::vector<EquivalenceRow>& rows) {
  std::string text =
      fmt::format(fmt::runtime(columns), "scene", "kernel", "check", "measured", "allowed", "");
  for (const EquivalenceRow& row : rows) {
    text += fmt::format(fmt::runtime(columns), row.scene, row.kernel, row.check, row.measured,
                        row.allowed, row.pass ? "ok" : "FAILED");
  }
  return text;
}

bool is_equivalent(const std::vector<EquivalenceRow>& rows) {
  return !rows.empty() && rows_that_hold(rows) == static_cast<std::ptrdiff_t>(rows.size());
}

std::string equivalence_verdict(const std::vector<EquivalenceRow>& rows) {
  return fmt::format("{}: {} of {} rows hold",
                     is_equivalent(rows) ? "equivalent" : "NOT EQUIVALENT", rows_that_hold(rows),
                     rows.size());
}

}  // namespace bounce
