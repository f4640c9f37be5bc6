// GSL's adaptive steppers as baselines: contacts located as in a reference (contact_course.hpp).
#pragma once

#include <functional>
#include <span>

#include "verify/accuracy/baseline.hpp"

namespace bounce {

/// Runge-Kutta-Fehlberg of orders 4 and 5, Prince-Dormand of 8 and 9, and Adams's multistep method
/// of orders 1 to 12, to a tolerance as AdaptiveSettings has it; and two for stiff motions:
/// backward differences of orders 1 to 5, and Bader and Deuflhard's extrapolation of the implicit
/// midpoint rule, at most 1000 particles. As Baseline::solve.
BaselineWork solve_rkf45(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick);
BaselineWork solve_rk8pd(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick);
BaselineWork solve_msadams(const Problem& problem, double tolerance, std::span<const double> times,
                           const ReferenceVisitor& visit, const std::function<void()>& tick);
BaselineWork solve_msbdf(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick);
BaselineWork solve_bsimp(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick);

}  // namespace bounce
