#include "driver/run/run_record.hpp"

#include <cmath>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/run/run_summary.hpp"
#include "driver/run/trouble_text.hpp"
#include "driver/world/origin.hpp"

namespace bounce {
namespace {

using Json = nlohmann::ordered_json;

Json plan_json(const Plan& plan) {
  return {{"kernel", plan.kernel},
          {"inside", plan.inside.empty() ? Json() : Json(plan.inside)},
          {"vector", std::string(name_of(plan.vector))},
          {"lanes", plan.lanes},
          {"threads", plan.threads},
          {"law", plan.law},
          {"walls", plan.walls},
          {"left_out", plan.left_out},
          {"reasons", plan.reasons}};
}

Json origin_json() {
  const Origin origin = find_origin();
  return {{"version", origin.version}, {"commit", origin.commit}, {"compiler", origin.compiler},
          {"flags", origin.flags},     {"cpu", origin.cpu},       {"cores", origin.cores},
          {"date", origin.date}};
}

Json energies_json(const Sample& sample) {
  return {{"kinetic", sample.kinetic},
          {"bond", sample.bond},
          {"gravity", sample.gravity},
          {"total", sample.total()}};
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

// How far from the edge of stability; null where a stiffness is not finite.
Json stability_json(const RunRecord& record) {
  Json json{{"omega_max", Json()}, {"stable_step", Json()}, {"part", Json()}};
  if (const auto& check = record.step_check) {
    json = {{"omega_max", check->fastest.omega},
            {"omega_max_from", check->fastest.exact ? "lanczos" : "bound"},
            {"stable_step", number(check->stable_step)},
            {"part", check->part}};
  }
  if (const auto& margin = record.margin) {
    json["greatest_part"] = {{"part", margin->part},
                             {"from", margin->exact ? "lanczos" : "bound"},
                             {"at_most", number(margin->at_most)},
                             {"step", margin->step},
                             {"time", static_cast<double>(margin->step) * record.scene.time.step},
                             {"bond", {margin->first + 1, margin->second + 1}},
                             {"ratio", margin->ratio}};
  }
  return json;
}

}  // namespace

std::string name_of(RunStatus status) {
  switch (status) {
    case RunStatus::complete:
      return "complete";
    case RunStatus::interrupted:
      return "interrupted";
    case RunStatus::unstable:
      break;
  }
  return "unstable";
}

double steps_per_second(const RunResult& result) {
  return result.steps_timed > 0 && result.seconds > 0.0
             ? static_cast<double>(result.steps_timed) / result.seconds
             : 0.0;
}

std::string run_json(const RunRecord& record) {
  const RunResult& result = record.result;
  Json json{{"title", record.scene.title},
            {"scene", record.scene_name},
            {"initial", record.initial.empty() ? Json() : Json(record.initial)},
            {"command", record.command},
            {"status", name_of(result.status)}};
  if (!record.advice.empty()) json["advice"] = record.advice;
  if (!record.resumed.empty()) json["resumed_at_steps"] = record.resumed;
  if (record.trouble_report) json["trouble"] = trouble_json(record);
  json["steps"] = result.step;
  json["steps_asked"] = record.steps_asked;
  json["time"] = static_cast<double>(result.step) * record.scene.time.step;
  json["time_integrated"] = static_cast<double>(result.step) * record.findings.integrated_step;
  json["state_hash"] = fmt::format("{:016x}", state_hash(result.last));
  json["wall_seconds"] = result.seconds;
  json["steps_per_second"] = steps_per_second(result);
  json["particles"] = record.particles;
  json["bonds"] = record.bonds;
  json["method"] = record.scene.time.method;
  json["plan"] = plan_json(record.plan);
  json["stability"] = stability_json(record);
  json["energies_at_start"] = energies_json(result.start);
  json["bounce"] = bounce_json(record.findings);
  json["ledger"] = ledger_json(record.findings);
  json["origin"] = origin_json();
  // Names and paths need not be UTF-8; what is not is replaced.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bounce
