// The strict kernel as the plan sees it; strict.cpp says how it works.
#pragma once

#include "kernels/plan/plan.hpp"

namespace bounce {

/// Registry entry of `strict`.
KernelEntry strict_entry();

}  // namespace bounce
