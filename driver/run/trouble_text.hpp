// What is said of a run that has become unstable, for people and for run.json.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "driver/run/run_record.hpp"

namespace bounce {

/// Some lines: step, time, what is wrong, particles, bond and its class, R/R0, the energy, the time
/// step against the edge before and at the refused step, and a step that would have been stable.
/// Particles and rings from 1. For records with a trouble_report, as all below.
std::string trouble_text(const RunRecord& record);

/// Where the last good state is, and the command that runs it on; `directory` is the run's.
std::string how_to_go_on(const RunRecord& record, const std::string& directory);

/// The object `trouble` of run.json. What is not finite is null.
nlohmann::ordered_json trouble_json(const RunRecord& record);

}  // namespace bounce
