// A Flow (contact_solver.hpp) over one of GSL's odeiv2 steppers, in double precision, steps as
// large as their error allows.
//
//  1. odeiv2 offers four levels; this uses the lower two, a single step and the control that judges
//     it, because a step must be made anew, shorter, where something happens within it
//     (gsl_odeiv2_evolve would have taken it already). The driver is there because the multistep
//     methods ask it for the control.
//  2. A multistep method cannot make a step anew as often as the search of an event wants: GSL puts
//     it back to order 1; a stiff method would factorise its matrix anew each time. There the
//     shorter step is made by rk8pd, in parts short enough for it, and the method begins afresh
//     after it, as it must after a contact anyway.
//  3. The stiff methods (msbdf, bsimp) want the derivatives of the rates, 4 n x 4 n and dense: the
//     bonds' Hessian and a unit matrix, nearly all of it zeros that GSL cannot leave out.
#pragma once

#include <gsl/gsl_odeiv2.h>

#include <functional>
#include <memory>
#include <vector>

#include "kernels/contact/contact_solver.hpp"

namespace bounce {

class GslFlow {
 public:
  using Real = double;

  /// `tolerance`: error allowed a step, as AdaptiveSettings has it. `tick` is called before each
  /// step; it may throw to stop.
  GslFlow(const Problem& problem, const gsl_odeiv2_step_type* type, double tolerance,
          std::function<void()> tick = {});
  GslFlow(const GslFlow&) = delete;  // GSL keeps its address
  GslFlow& operator=(const GslFlow&) = delete;

  [[nodiscard]] const BondForces<double>& forces() const { return forces_; }
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& end() const { return end_; }
  void begin(const std::vector<double>& state, const Resting& resting);
  double attempt(double left);
  void retake(double h);
  void accept();

  /// As GSL calls them; `self` is the flow, which has begun. Rates of a state, and the derivatives
  /// of each (rows) by each number of the state and by time.
  static int derivative(double time, const double* state, double* rate, void* self);
  static int jacobian(double time, const double* state, double* by_state, double* by_time,
                      void* self);

 private:
  struct Release {
    void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
    void operator()(gsl_odeiv2_step* step) const { gsl_odeiv2_step_free(step); }
  };
  bool take(double h);
  void cut(double h);

  const Problem* problem_;
  BondForces<double> forces_;
  gsl_odeiv2_system system_;
  std::unique_ptr<gsl_odeiv2_driver, Release> driver_;
  std::unique_ptr<gsl_odeiv2_step, Release> cutter_;  // of a multistep or a stiff method
  double cutters_step_ = 0.0;                         // s, at most
  std::function<void()> tick_;
  const Resting* resting_ = nullptr;
  std::vector<double> start_, end_, error_, start_rate_, end_rate_, part_rate_;
  double time_ = 0.0;    // s; a multistep method knows a step made anew by it
  double length_ = 0.0;  // of the step to end_, s
  double next_ = 1e-6;   // s; finds its size in a few steps
  bool cut_ = false;     // end_ is the cutter's
  std::int64_t evaluations_ = 0;
};

}  // namespace bounce
