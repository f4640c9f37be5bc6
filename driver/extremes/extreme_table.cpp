#include "driver/extremes/extreme_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "driver/world/origin.hpp"

namespace bounce {
namespace {

std::string replaced(const std::string& text, char what, const std::string& by) {
  std::string out;
  for (const char c : text) out += c == what ? by : std::string(1, c);
  return out;
}

std::string cell(const std::string& text) { return replaced(text, '|', "\\|"); }
std::string quoted(const std::string& text) { return '"' + replaced(text, '"', "\"\"") + '"'; }

std::string part_of(const ExtremeResult& result) {
  return result.greatest_part ? fmt::format("{:.3g}", *result.greatest_part) : "-";
}

}  // namespace

std::string line_of(const ExtremeEntry& entry) {
  const ExtremeResult& result = entry.result;
  return fmt::format("{:<6} {:<24} {}: {}", result.as_expected ? "ok" : "FAILED", entry.row.name,
                     result.happened, result.detail);
}

std::string extremes_markdown(const std::vector<ExtremeEntry>& entries,
                              const std::string& command) {
  const auto good = std::count_if(entries.begin(), entries.end(), [](const ExtremeEntry& entry) {
    return entry.result.as_expected;
  });
  std::string text = fmt::format(
      "# Stiff and extreme\n\n{} of {} rows as expected. A row is the file "
      "`driver/scenes/extremes/ROW.toml`; part: time step /\nstable step, the greatest used.\n\n"
      "| row | scene | expected | because | happened | part | |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n",
      good, entries.size());
  for (const auto& [row, result] : entries) {
    text +=
        fmt::format("| {} | {} | {} | {} | {}: {} | {} | {} |\n", row.name, cell(row.scene.title),
                    name_of(row.expected), cell(row.because), result.happened, cell(result.detail),
                    part_of(result), result.as_expected ? "ok" : "**FAILED**");
  }
  const Origin origin = find_origin();
  return text + fmt::format("\nMade by `{}` at commit {}, {}, on {} ({} cores), {}, {}.\n", command,
                            origin.commit, origin.date, origin.cpu, origin.cores, origin.compiler,
                            origin.flags);
}

std::string extremes_csv(const std::vector<ExtremeEntry>& entries) {
  std::string text =
      "row,group,scene,expected,because,happened,as_expected,exit_code,steps,greatest_part,"
      "detail\n";
  for (const auto& [row, result] : entries) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", row.name, row.group,
                        quoted(row.scene.title), name_of(row.expected), quoted(row.because),
                        result.happened, result.as_expected ? 1 : 0, result.exit_code, result.steps,
                        result.greatest_part ? fmt::format("{:.6g}", *result.greatest_part) : "",
                        quoted(result.detail));
  }
  return text;
}

}  // namespace bounce
