// run.json: what ran, where, how fast, and to which end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "driver/run/run_gauges.hpp"
#include "driver/run/run_loop.hpp"
#include "driver/scene/step_check.hpp"
#include "kernels/model/scene.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/stability/trouble_report.hpp"

namespace bounce {

/// All that run.json tells.
struct RunRecord {
  std::string command;                ///< the command line
  std::string scene_name;             ///< built-in name or file
  std::string initial;                ///< file of the initial state, or "" for the scene's ball
  std::string advice;                 ///< what --error was answered with, or ""
  std::vector<std::int64_t> resumed;  ///< steps from which it was gone on with
  Scene scene;
  Plan plan;
  std::size_t particles = 0, bonds = 0;
  std::int64_t steps_asked = 0;
  RunResult result;
  std::optional<TroubleReport> trouble_report;  ///< of an unstable run
  RunFindings findings;
  std::optional<StepCheck> step_check;  ///< at the start; nothing: no finite stiffness there
  std::optional<Margin> margin;         ///< of the states of monitor.csv's rows
};

/// "complete", "interrupted" or "unstable".
std::string name_of(RunStatus status);

/// Steps a second of wall time; 0 if none were taken.
double steps_per_second(const RunResult& result);

std::string run_json(const RunRecord& record);

}  // namespace bounce
