#include "verify/accuracy/gsl_flow.hpp"

#include <gsl/gsl_errno.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <string>

#include "verify/accuracy/reference_solution.hpp"
#include "verify/vibrations/spectrum.hpp"

namespace bounce {
namespace {

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

// Of which the tolerance is the error allowed a step, by component.
std::vector<double> scale_of(const Problem& problem) {
  const double size = size_of(problem.initial);
  const double omega = reference_frequency(problem);
  std::vector<double> scale(4 * problem.initial.size(), size);
  std::fill(scale.begin() + static_cast<std::ptrdiff_t>(scale.size() / 2), scale.end(),
            size * (omega > 0.0 ? omega / slow_share : 1.0));
  return scale;
}

bool all_finite(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value - value;
  return sum == 0.0;
}

bool is_multistep(const gsl_odeiv2_step_type* type) {
  return type == gsl_odeiv2_step_msadams || type == gsl_odeiv2_step_msbdf;
}

bool is_stiff(const gsl_odeiv2_step_type* type) {
  return type == gsl_odeiv2_step_msbdf || type == gsl_odeiv2_step_bsimp;
}

// Of the stiff methods, whose matrices are then of 128 MB each.
constexpr std::size_t most_particles = 1000;

constexpr double first_step = 1e-6;  // s; for the driver, which takes none itself

}  // namespace

GslFlow::GslFlow(const Problem& problem, const gsl_odeiv2_step_type* type, double tolerance,
                 std::function<void()> tick)
    : problem_(&problem),
      forces_(problem),
      system_{derivative, jacobian, 4 * problem.initial.size(), this},
      tick_(std::move(tick)),
      end_(system_.dimension),
      error_(system_.dimension),
      start_rate_(system_.dimension),
      end_rate_(system_.dimension),
      part_rate_(system_.dimension) {
  if (is_stiff(type) && problem.initial.size() > most_particles) {
    throw ReferenceError("GSL's stiff steppers keep dense matrices: at most " +
                         std::to_string(most_particles) + " particles");
  }
  // What GSL cannot do (memory, a matrix without inverse) it says by what it returns; it would end
  // the program otherwise.
  static gsl_error_handler_t* const before = gsl_set_error_handler_off();
  static_cast<void>(before);
  const std::vector<double> scale = scale_of(problem);
  driver_.reset(gsl_odeiv2_driver_alloc_scaled_new(&system_, type, first_step, tolerance, 0.0, 1.0,
                                                   0.0, scale.data()));
  const bool is_cut = is_multistep(type) || is_stiff(type);
  if (is_cut) cutter_.reset(gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, system_.dimension));
  if (!driver_ || (is_cut && !cutter_)) throw std::bad_alloc();
  const double omega = reference_frequency(problem);
  cutters_step_ = omega > 0.0 ? 1.0 / omega : std::numeric_limits<double>::infinity();
}

void GslFlow::begin(const std::vector<double>& state, const Resting& resting) {
  start_ = state;
  resting_ = &resting;
  derivative(0.0, start_.data(), start_rate_.data(), this);
  if (cutter_) gsl_odeiv2_step_reset(driver_->s);
}

double GslFlow::attempt(double left) {
  if (tick_) tick_();
  // No sliver at the end.
  double h = next_ >= left ? left : std::min(next_, left / 2);
  for (;;) {
    const bool made = take(h);
    double proposed = h;
    const int verdict = gsl_odeiv2_control_hadjust(driver_->c, driver_->s, end_.data(),
                                                   error_.data(), end_rate_.data(), &proposed);
    const bool finite = made && all_finite(error_);  // GSL's control passes a NaN
    if (finite && verdict != GSL_ODEIV_HADJ_DEC) {
      // A step shorter than it could have been says little of the next one.
      next_ = h < next_ ? std::max(next_, proposed) : proposed;
      cut_ = false;
      return h;
    }
    next_ = h = finite ? proposed : h / 10.0;
    // Far below the period of any vibration that double precision could follow.
    constexpr double least_step = 1e-18;
    if (!(h > least_step) || time_ + h == time_) {
      throw ReferenceError(
          "the adaptive solution's step fell below 1e-18 s or a rounding of the time: no step "
          "follows the motion to this tolerance");
    }
  }
}

void GslFlow::retake(double h) {
  cut_ = cutter_ != nullptr;
  if (cut_) {
    cut(h);
  } else {
    take(h);
  }
}

void GslFlow::accept() {
  start_.swap(end_);
  start_rate_.swap(end_rate_);
  time_ += length_;
  if (cut_) gsl_odeiv2_step_reset(driver_->s);
}

// False if the step's own equations (of an implicit method) have not been solved.
bool GslFlow::take(double h) {
  end_ = start_;
  length_ = h;
  return gsl_odeiv2_step_apply(driver_->s, time_, h, end_.data(), error_.data(), start_rate_.data(),
                               end_rate_.data(), &system_) == GSL_SUCCESS;
}

void GslFlow::cut(double h) {
  const auto parts = static_cast<std::int64_t>(std::max(1.0, std::ceil(h / cutters_step_)));
  const double part = h / static_cast<double>(parts);
  end_ = start_;
  end_rate_ = start_rate_;
  length_ = h;
  for (std::int64_t k = 0; k < parts; ++k) {
    part_rate_ = end_rate_;
    gsl_odeiv2_step_apply(cutter_.get(), time_ + static_cast<double>(k) * part, part, end_.data(),
                          error_.data(), part_rate_.data(), end_rate_.data(), &system_);
  }
}

int GslFlow::derivative(double /*time*/, const double* state, double* rate, void* self) {
  auto& flow = *static_cast<GslFlow*>(self);
  ++flow.evaluations_;
  const std::size_t n = flow.forces_.particles();
  const StateParts<const double> s(state, n);
  const StateParts<double> r(rate, n);
  std::copy(s.vx, s.vx + 2 * n, r.x);
  flow.forces_(s.x, s.y, r.vx, r.vy);
  flow.resting_->hold(r.vx, r.vy);
  return GSL_SUCCESS;
}

// Rows and columns as a state: x, y, vx, vy, n each.
int GslFlow::jacobian(double /*time*/, const double* state, double* by_state, double* by_time,
                      void* self) {
  const auto& flow = *static_cast<const GslFlow*>(self);
  const std::size_t n = flow.forces_.particles(), all = 4 * n;
  std::fill(by_state, by_state + all * all, 0.0);
  std::fill(by_time, by_time + all, 0.0);
  for (std::size_t k = 0; k < 2 * n; ++k) by_state[k * all + 2 * n + k] = 1.0;
  State places(n);
  std::copy(state, state + n, places.x.begin());
  std::copy(state + n, state + 2 * n, places.y.begin());
  const Hessian hessian = bond_hessian(*flow.problem_, places);
  const auto place = [n](Eigen::Index k) {  // of x1, y1, x2, ... in x1, x2, ..., y1, ...
    return static_cast<std::size_t>(k % 2) * n + static_cast<std::size_t>(k / 2);
  };
  for (Eigen::Index row = 0; row < hessian.outerSize(); ++row) {
    for (Hessian::InnerIterator entry(hessian, row); entry; ++entry) {
      by_state[(2 * n + place(row)) * all + place(entry.col())] = -entry.value();
    }
  }
  for (const std::size_t i : flow.resting_->particles()) {
    double* const x = by_state + (2 * n + i) * all;
    double* const y = by_state + (3 * n + i) * all;
    for (std::size_t k = 0; k < 2 * n; ++k) flow.resting_->hold(i, x[k], y[k]);
  }
  return GSL_SUCCESS;
}

}  // namespace bounce
