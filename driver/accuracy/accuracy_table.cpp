#include "driver/accuracy/accuracy_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "driver/scene/scene_keys.hpp"

namespace bounce {
namespace {

std::string parameter_of(const AccuracyRow& row) {
  return row.tolerance > 0.0 ? fmt::format("tol {:.0e}", row.tolerance)
                             : fmt::format("{:.3g}", row.step);
}

// An error as far as the reference can tell it.
std::string known_error(double error, double bar) {
  if (std::isfinite(error) && error <= bar) return fmt::format("<{:.1e}", bar);
  return fmt::format("{:.1e}", error);
}

std::string line_of(const TimedRow& timed, const CourseErrors& bar) {
  const AccuracyRow& row = timed.row;
  std::string line =
      fmt::format("{:<15} {:<9} {:>9} {:>9.3g} {:>9}", row.setting.method, contact_name(row),
                  parameter_of(row), timed.seconds, known_error(row.errors.position, bar.position));
  for (const ObservableName& each : observable_names) {
    line += fmt::format(
        " {:>9}", known_error(row.errors.observables.*each.value, bar.observables.*each.value));
  }
  line += fmt::format(" {:>9}\n", known_error(row.errors.energy, bar.energy));
  return row.note.empty() ? line : line + fmt::format("  ({})\n", row.note);
}

// A text as a field of CSV.
std::string quoted(std::string_view text) {
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text.empty() ? "" : field + "\"";
}

std::string head_of_table() {
  std::string head = fmt::format("{:<15} {:<9} {:>9} {:>9} {:>9}", "method", "contact", "dt, s",
                                 "run, s", "position");
  for (const ObservableName& each : observable_names) {
    head += fmt::format(" {:>9}", each.name.substr(0, 9));
  }
  return head + fmt::format(" {:>9}\n", "energy");
}

std::string papers_text(std::span<const TimedRow> rows, const PapersProgram& papers,
                        const CourseErrors& bar) {
  if (!papers.row || papers.seconds == 0.0) return {};
  std::string text = fmt::format(
      "\nThe paper's program (oracle, 1e-6 s) takes {:.3g} s for this; its errors are those of the "
      "row\nlisting, listing, 1e-06.\n",
      papers.seconds);
  const auto best = cheapest_as_good(rows, papers, bar);
  if (!best) return text + "No setting here is as good in every observable.\n";
  const TimedRow& row = rows[*best];
  return text + fmt::format(
                    "The cheapest row here that is no worse in any observable: {}, contact {},\n"
                    "dt = {:.3g} s, in {:.3g} s: {:.0f} times sooner.\n",
                    row.row.setting.method, contact_name(row.row), row.row.step, row.seconds,
                    papers.seconds / row.seconds);
}

}  // namespace

std::string_view contact_name(const AccuracyRow& row) {
  if (row.baseline == BaselineContact::located) return "located";
  return word_of(row.setting.contact);
}

std::optional<std::size_t> cheapest_as_good(std::span<const TimedRow> rows,
                                            const PapersProgram& papers, const CourseErrors& bar) {
  if (!papers.row) return {};
  const Observables& allowed = rows[*papers.row].row.errors.observables;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Observables& errors = rows[i].row.errors.observables;
    const bool good = std::all_of(
        observable_names.begin(), observable_names.end(), [&](const ObservableName& each) {
          const double least = bar.observables.*each.value;
          const double most = error_or_bar(allowed.*each.value, least);
          return std::isfinite(most) &&
                 error_or_bar(errors.*each.value, least) <= most;  // false for a NaN
        });
    if (!good || !std::isfinite(rows[i].seconds)) continue;
    if (!best || rows[i].seconds < rows[*best].seconds) best = i;
  }
  return best;
}

std::string accuracy_csv(std::span<const TimedRow> rows, const CourseRecord& reference,
                         const CourseErrors& bar) {
  std::string csv = "method,contact,dt,tolerance,steps,evaluations,kernel,seconds,error_position";
  for (const ObservableName& each : observable_names) csv += fmt::format(",error_{}", each.name);
  csv += ",error_energy,error_energy_free";
  for (const ObservableName& each : observable_names) csv += fmt::format(",{}", each.name);
  csv += ",note\nreference,,,,,,,," + fmt::format("{:.4g}", bar.position);
  for (const ObservableName& each : observable_names) {
    csv += fmt::format(",{:.4g}", bar.observables.*each.value);
  }
  csv += fmt::format(",{:.4g},{:.4g}", bar.energy, bar.energy_free);
  for (const ObservableName& each : observable_names) {
    csv += fmt::format(",{:.12g}", reference.observables.*each.value);
  }
  csv += ",\n";
  for (const TimedRow& timed : rows) {
    const AccuracyRow& row = timed.row;
    csv += fmt::format("{},{},{},{},{},{},{},{:.4g},{:.4g}", row.setting.method, contact_name(row),
                       row.step, row.tolerance > 0.0 ? fmt::format("{:.0e}", row.tolerance) : "",
                       row.steps, row.evaluations, row.kernel, timed.seconds, row.errors.position);
    for (const ObservableName& each : observable_names) {
      csv += fmt::format(",{:.4g}", row.errors.observables.*each.value);
    }
    csv += fmt::format(",{:.4g},{:.4g}", row.errors.energy, row.errors.energy_free);
    for (const ObservableName& each : observable_names) {
      csv += fmt::format(",{:.12g}", row.record.observables.*each.value);
    }
    csv += fmt::format(",{}\n", quoted(row.note));
  }
  return csv;
}

std::string accuracy_table(std::span<const TimedRow> rows, const PapersProgram& papers,
                           const CourseRecord& reference, const CourseErrors& bar) {
  std::string text =
      "The course, and how well it is known (what the reference courses differ by):\n";
  for (const ObservableName& each : observable_names) {
    text += fmt::format("  {:<12} {:>16.10g} {:<5} +- {:.1e}\n", each.name,
                        reference.observables.*each.value, each.unit, bar.observables.*each.value);
  }
  text +=
      "\nErrors. position: largest of a particle just before the impact, cm; energy: largest "
      "difference of\nenergy at any time, erg. Run: on one thread, without output.\n" +
      head_of_table();
  for (const TimedRow& timed : rows) text += line_of(timed, bar);
  return text + papers_text(rows, papers, bar);
}

}  // namespace bounce
