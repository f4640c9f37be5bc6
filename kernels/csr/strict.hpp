// The strict kernel as the plan sees it; strict.cpp says how it works.
#pragma once

#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// Registry entry of `strict`.
KernelEntry strict_entry();

}  // namespace bounce
