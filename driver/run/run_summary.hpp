// What a run found, for people and for run.json.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "driver/run/run_gauges.hpp"

namespace bounce {

/// Lines on energy, bounce and ledgers. A ledger that does not close is named, with what is left
/// over and what rounding explains.
std::string summary_text(const RunFindings& findings);

/// The objects `bounce` and `ledger` of run.json. What there is none of is null.
nlohmann::ordered_json bounce_json(const RunFindings& findings);
nlohmann::ordered_json ledger_json(const RunFindings& findings);

}  // namespace bounce
