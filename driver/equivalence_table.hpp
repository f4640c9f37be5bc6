// What bounce verify prints: the rows of its checks, and the verdict on all of them.
#pragma once

#include <string>
#include <vector>

#include "verify/oracle/equivalence.hpp"

namespace bounce {

/// A header, and a line a row: scene, kernel, check, measured, allowed, "ok" or "FAILED".
std::string equivalence_table(const std::vector<EquivalenceRow>& rows);

/// Every row holds, and there is one.
bool is_equivalent(const std::vector<EquivalenceRow>& rows);

/// "equivalent: 12 of 12 rows hold"
std::string equivalence_verdict(const std::vector<EquivalenceRow>& rows);

}  // namespace bounce
