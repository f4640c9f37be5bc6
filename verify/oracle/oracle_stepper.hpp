// The oracle as one kernel among the others: `--kernel oracle`.
#pragma once

#include <vector>

#include "kernels/plan/plan.hpp"

namespace bounce {

/// kernels() and, last, the entry "oracle", which `auto` never picks. A Problem has no nominal
/// decimals, from which the oracle makes its constants, so the entry keeps the scene; the start is
/// the problem's.
std::vector<KernelEntry> kernels_with_oracle(const Scene& scene);

}  // namespace bounce
