#include "driver/run/trouble_text.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/world/input_error.hpp"
#include "driver/world/shell_word.hpp"

namespace bounce {
namespace {

using Json = nlohmann::ordered_json;

double time_of(const RunRecord& record, std::int64_t step) {
  return static_cast<double>(step) * record.scene.time.step;
}

// "unstable at step 12 (t = 1.2e-05 s): ..."
std::string headline(const RunRecord& record) {
  const RunResult& result = record.result;
  const Trouble& trouble = *result.trouble;
  std::string text = fmt::format("unstable at step {} (t = {:.9g} s): {}", result.trouble_step,
                                 time_of(record, result.trouble_step), trouble.what);
  // The watch's sentence names what it is about; the rest is added.
  const auto lacks = [&trouble](const char* word) {
    return trouble.what.find(word) == std::string::npos;
  };
  if (trouble.particle >= 0 && lacks("particle ")) {
    text += fmt::format("; particle {}", trouble.particle + 1);
  }
  if (trouble.bond_first >= 0 && lacks("bond ")) {
    text += fmt::format("; bond {}-{}", trouble.bond_first + 1, trouble.bond_second + 1);
  }
  return plain_nan(std::move(text));
}

std::string part_text(const std::optional<EdgeDistance>& edge) {
  return edge ? fmt::format("{:.4g}", edge->part) : "unknown (a stiffness is not finite)";
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json state_json(const TroubledState& state) {
  Json json{{"energy", number(state.energy)},
            {"ratio", number(state.ratio)},
            {"part", Json()},
            {"stable_step", Json()}};
  if (state.edge) {
    json["part"] = number(state.edge->part);
    json["stable_step"] = number(state.edge->stable_step);
  }
  return json;
}

}  // namespace

std::string trouble_text(const RunRecord& record) {
  const TroubleReport& report = *record.trouble_report;
  const RunResult& result = record.result;
  std::string text = headline(record) + "\n";
  if (!report.bond_class.empty()) {
    text += fmt::format("  bond {}-{}, {}: R/R0 = {:.3g}", result.trouble->bond_first + 1,
                        result.trouble->bond_second + 1, report.bond_class, report.refused.ratio);
    if (report.before) text += fmt::format(", a step before {:.3g}", report.before->ratio);
    text += "\n";
  }
  if (report.before) {
    text += fmt::format("  energy: {:.4g} erg, {:.4g} erg of them came up in this step\n",
                        report.refused.energy, report.energy_jump());
    text += fmt::format("  time step: {} of the stable step a step before, {} now\n",
                        part_text(report.before->edge), part_text(report.refused.edge));
  } else {
    text += "  time step: " + part_text(report.refused.edge) + " of the stable step\n";
  }
  text += report.stable_step
              ? fmt::format(
                    "  stable would have been: {:.2g} s ({:g} of the smallest stable step of "
                    "the good states known)\n",
                    *report.stable_step, step_safety)
              : std::string("  no step is known that would have been stable\n");
  if (result.looked_from > 0) {
    text += fmt::format(
        "  it is the first: every step from {} on was looked at, and the rows of monitor.csv "
        "before\n",
        result.looked_from);
  }
  return text;
}

std::string how_to_go_on(const RunRecord& record, const std::string& directory) {
  if (record.result.start_refused) return "There is no good state: the start was refused.\n";
  std::string text = fmt::format("The last good state, of step {}, is in {}/final.csv.",
                                 record.result.step, directory);
  if (const auto step = record.trouble_report->stable_step) {
    text += fmt::format(" It can be run on:\n  bounce run {} --initial {} --set time.step={:.2g}",
                        shell_word(directory + "/scene.toml"), shell_word(directory + "/final.csv"),
                        *step);
  }
  return text + "\n";
}

Json trouble_json(const RunRecord& record) {
  const RunResult& result = record.result;
  const Trouble& trouble = *result.trouble;
  const TroubleReport& report = *record.trouble_report;
  Json json{{"message", headline(record)},
            {"step", result.trouble_step},
            {"time", time_of(record, result.trouble_step)},
            {"looked_from", result.looked_from}};
  if (trouble.particle >= 0) json["particle"] = trouble.particle + 1;
  if (trouble.bond_first >= 0) {
    json["bond"] = {trouble.bond_first + 1, trouble.bond_second + 1};
    json["bond_class"] = report.bond_class;
    json["ratio"] = number(report.refused.ratio);
  }
  json["energy_jump"] = number(report.energy_jump());
  json["refused"] = state_json(report.refused);
  json["last_good"] = Json();
  if (report.before) {
    json["last_good"] = state_json(*report.before);
    json["last_good"]["step"] = result.step;
  }
  json["stable_step"] = report.stable_step ? Json(*report.stable_step) : Json();
  return json;
}

}  // namespace bounce
