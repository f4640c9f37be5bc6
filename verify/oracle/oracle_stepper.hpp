// The oracle (oracle.hpp) as one kernel among the others, under the name "oracle".
#pragma once

#include <memory>
#include <vector>

#include "kernels/plan/plan.hpp"
#include "verify/watch/booking_stepper.hpp"

namespace bounce {

/// kernels() and, last, the entry "oracle", which `auto` never picks. A Problem has no nominal
/// decimals, from which the oracle makes its constants, so the entry keeps the scene; the start is
/// the problem's.
std::vector<KernelEntry> kernels_with_oracle(const Scene& scene);

/// A plan's kernel with its books. The oracle takes its walls from the scene, so the scene is
/// needed beside the problem.
std::unique_ptr<BookingStepper> make_booking_stepper(const Scene& scene, const Problem& problem,
                                                     const Plan& plan);

}  // namespace bounce
