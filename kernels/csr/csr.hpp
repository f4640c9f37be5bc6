// The csr kernel as the plan sees it; csr_physics-inl.hpp says how it works.
#pragma once

#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// Registry entry of `csr`.
KernelEntry csr_entry();

}  // namespace bounce
