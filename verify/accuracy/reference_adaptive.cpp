// Solution one: GSL's rk8pd in double precision, steps as large as their error allows.
#include "kernels/contact/contact_solver.hpp"
#include "verify/accuracy/gsl_flow.hpp"
#include "verify/accuracy/reference_solution.hpp"

namespace bounce {

ReferenceRun solve_adaptive(const Problem& problem, std::span<const double> times,
                            const AdaptiveSettings& settings, const ReferenceVisitor& visit,
                            ContactWatch* watch) {
  check_output_times(times);
  // Below some roundings of a position no error estimate means anything.
  if (!(settings.tolerance >= 1e-15 && settings.tolerance <= 1e-2)) {
    throw std::invalid_argument("tolerance " + std::to_string(settings.tolerance) +
                                ": allowed is 1e-15 to 0.01");
  }
  GslFlow flow(problem, gsl_odeiv2_step_rk8pd, settings.tolerance);
  return ContactSolver<GslFlow>(problem, flow).run(times, visit, watch);
}

}  // namespace bounce
