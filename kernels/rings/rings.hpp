// The rings kernel as the plan sees it; rings_stepper-inl.hpp says how it works.
#pragma once

#include "kernels/plan/plan.hpp"

namespace bounce {

/// Registry entry of `rings`.
KernelEntry rings_entry();

}  // namespace bounce
