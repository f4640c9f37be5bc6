// The kernel ring in precisions other than double; ring_precision-inl.hpp says how it works.
#pragma once

#include <memory>
#include <string>

#include "kernels/stepping/plan.hpp"
#include "kernels/stepping/ring_shape.hpp"

namespace bounce {

/// As KernelEntry::prepare, for a problem whose precision is not double.
std::string prepare_ring_precision(const Problem& problem, const RingShape& shape,
                                   const PlanRequest& request, Plan& plan);

/// The stepper for such a plan.
std::unique_ptr<Stepper> make_ring_precision(const Problem& problem, const RingShape& shape,
                                             const Plan& plan);

}  // namespace bounce
