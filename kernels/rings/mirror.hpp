// The mirror kernel as the plan sees it; mirror_stepper-inl.hpp says how it works.
#pragma once

#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// Registry entry of `mirror`.
KernelEntry mirror_entry();

}  // namespace bounce
