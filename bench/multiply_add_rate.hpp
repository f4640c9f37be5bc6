// How fast this core multiplies: what a kernel's operation count is held against.
#pragma once

#include "kernels/plan/plan.hpp"

namespace bounce {

/// Multiply-adds of whole vectors of the target a second, all independent, in registers; measured
/// now, in some 0.3 ms. The target must be an available one.
double multiply_add_rate(VectorTarget target);

}  // namespace bounce
