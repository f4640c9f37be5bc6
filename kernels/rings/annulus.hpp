// The annulus kernel as the plan sees it; annulus_stepper-inl.hpp says how it works.
#pragma once

#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// Registry entry of `annulus`.
KernelEntry annulus_entry();

}  // namespace bounce
