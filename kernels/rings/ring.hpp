// The ring kernel as the plan sees it; ring_stepper-inl.hpp says how it works.
#pragma once

#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// Registry entry of `ring`.
KernelEntry ring_entry();

}  // namespace bounce
