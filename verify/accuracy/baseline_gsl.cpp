#include "verify/accuracy/baseline_gsl.hpp"

#include "kernels/contact/contact_course.hpp"
#include "verify/accuracy/gsl_flow.hpp"

namespace bounce {
namespace {

BaselineWork solve(const gsl_odeiv2_step_type* type, const Problem& problem, double tolerance,
                   std::span<const double> times, const ReferenceVisitor& visit,
                   const std::function<void()>& tick) {
  GslFlow flow(problem, type, tolerance, tick);
  const ReferenceRun run = ContactCourse<GslFlow>(problem, flow).run(times, visit);
  return {run.steps, run.evaluations};
}

}  // namespace

BaselineWork solve_rkf45(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick) {
  return solve(gsl_odeiv2_step_rkf45, problem, tolerance, times, visit, tick);
}

BaselineWork solve_rk8pd(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick) {
  return solve(gsl_odeiv2_step_rk8pd, problem, tolerance, times, visit, tick);
}

BaselineWork solve_msadams(const Problem& problem, double tolerance, std::span<const double> times,
                           const ReferenceVisitor& visit, const std::function<void()>& tick) {
  return solve(gsl_odeiv2_step_msadams, problem, tolerance, times, visit, tick);
}

BaselineWork solve_msbdf(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick) {
  return solve(gsl_odeiv2_step_msbdf, problem, tolerance, times, visit, tick);
}

BaselineWork solve_bsimp(const Problem& problem, double tolerance, std::span<const double> times,
                         const ReferenceVisitor& visit, const std::function<void()>& tick) {
  return solve(gsl_odeiv2_step_bsimp, problem, tolerance, times, visit, tick);
}

}  // namespace bounce
