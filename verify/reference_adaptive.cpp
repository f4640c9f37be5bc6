// Solution one: GSL's rk8pd in double precision, steps as large as their error allows.
//
// GSL's odeiv2 offers four levels; this uses the lower two, a single step and the control that
// judges it, because a step must be made anew, shorter, where something happens within it
// (gsl_odeiv2_evolve would have taken it already). Nothing of a step is carried on but the
// derivative at its end.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <memory>

#include "verify/contact_course.hpp"
#include "verify/reference_solution.hpp"

namespace bounce {
namespace {

struct Release {
  void operator()(gsl_odeiv2_step* step) const { gsl_odeiv2_step_free(step); }
  void operator()(gsl_odeiv2_control* control) const { gsl_odeiv2_control_free(control); }
};

class AdaptiveFlow {
 public:
  using Real = double;

  /// `scale`: of which `tolerance` is the error allowed a step, by component.
  AdaptiveFlow(const Problem& problem, double tolerance, const std::vector<double>& scale)
      : forces_(problem),
        system_{derivative, nullptr, scale.size(), this},
        step_(gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, scale.size())),
        control_(
            gsl_odeiv2_control_scaled_new(tolerance, 0.0, 1.0, 0.0, scale.data(), scale.size())),
        end_(scale.size()),
        error_(scale.size()),
        start_rate_(scale.size()),
        end_rate_(scale.size()) {
    if (!step_ || !control_) throw std::bad_alloc();
  }

  [[nodiscard]] const ReferenceForces<double>& forces() const { return forces_; }
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& end() const { return end_; }

  void begin(const std::vector<double>& state, const Resting& resting) {
    start_ = state;
    resting_ = &resting;
    derivative(0.0, start_.data(), start_rate_.data(), this);
  }

  double attempt(double left) {
    // No sliver at the end.
    double h = next_ >= left ? left : std::min(next_, left / 2);
    for (;;) {
      retake(h);
      double proposed = h;
      const int verdict = gsl_odeiv2_control_hadjust(control_.get(), step_.get(), end_.data(),
                                                     error_.data(), end_rate_.data(), &proposed);
      const bool finite = is_finite(error_);  // GSL's control passes a NaN
      if (finite && verdict != GSL_ODEIV_HADJ_DEC) {
        // A step shorter than it could have been says little of the next one.
        next_ = h < next_ ? std::max(next_, proposed) : proposed;
        return h;
      }
      next_ = h = finite ? proposed : h / 10.0;
      // Far below the period of any vibration that double precision could follow.
      constexpr double least_step = 1e-18;
      if (!(h > least_step)) {
        throw ReferenceError(
            "the adaptive solution's step fell below 1e-18 s: no step follows the motion to this "
            "tolerance");
      }
    }
  }

  void retake(double h) {
    end_ = start_;
    gsl_odeiv2_step_apply(step_.get(), 0.0, h, end_.data(), error_.data(), start_rate_.data(),
                          end_rate_.data(), &system_);
  }

  void accept() {
    start_.swap(end_);
    start_rate_.swap(end_rate_);
  }

 private:
  static int derivative(double /*time*/, const double* state, double* rate, void* self) {
    auto& flow = *static_cast<AdaptiveFlow*>(self);
    ++flow.evaluations_;
    const std::size_t n = flow.forces_.particles();
    const StateParts<const double> s(state, n);
    const StateParts<double> r(rate, n);
    std::copy(s.vx, s.vx + 2 * n, r.x);
    flow.forces_(s.x, s.y, r.vx, r.vy);
    flow.resting_->hold(r.vx, r.vy);
    return GSL_SUCCESS;
  }
  static bool is_finite(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value - value;
    return sum == 0.0;
  }

  ReferenceForces<double> forces_;
  gsl_odeiv2_system system_;
  std::unique_ptr<gsl_odeiv2_step, Release> step_;
  std::unique_ptr<gsl_odeiv2_control, Release> control_;
  const Resting* resting_ = nullptr;
  std::vector<double> start_, end_, error_, start_rate_, end_rate_;
  double next_ = 1e-6;  // s; finds its size in a few steps
  std::int64_t evaluations_ = 0;
};

// An error of velocity dv becomes one of position, dv / w, in a vibration of angular frequency w.
// The motions that matter to a bounce are slower than the fastest vibration by about as much as a
// ring has particles. (Measured on Example 1, free flight: errors of positions at t = 1 are then 50
// times the tolerance times the ball's size in cm; with the fastest vibration itself, 1000 times.)
constexpr double slow_share = 128.0;

// Greatest distance of a particle from the first one, as a measure of the ball, cm; above 0.
double size_of(const State& state) {
  double size = 0.0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    size = std::max(size, std::hypot(state.x[i] - state.x[0], state.y[i] - state.y[0]));
  }
  return size > 0.0 ? size : 1.0;
}

}  // namespace

ReferenceRun solve_adaptive(const Problem& problem, std::span<const double> times,
                            const AdaptiveSettings& settings, const ReferenceVisitor& visit) {
  check_output_times(times);
  // Below some roundings of a position no error estimate means anything.
  if (!(settings.tolerance >= 1e-15 && settings.tolerance <= 1e-2)) {
    throw std::invalid_argument("tolerance " + std::to_string(settings.tolerance) +
                                ": allowed is 1e-15 to 0.01");
  }
  const double size = size_of(problem.initial);
  const double omega = reference_frequency(problem);
  std::vector<double> scale(4 * problem.initial.size(), size);
  std::fill(scale.begin() + static_cast<std::ptrdiff_t>(scale.size() / 2), scale.end(),
            size * (omega > 0.0 ? omega / slow_share : 1.0));
  AdaptiveFlow flow(problem, settings.tolerance, scale);
  return ContactCourse<AdaptiveFlow>(problem, flow).run(times, visit);
}

}  // namespace bounce
