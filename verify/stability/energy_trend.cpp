#include "verify/stability/energy_trend.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "verify/watch/compensated_sum.hpp"
#include "verify/watch/inspection.hpp"

namespace bounce {
namespace {

constexpr double confidence = 0.975;  // of either side

// Standard deviation of the slope of a line that is fitted by least squares to a random walk of
// `steps` steps, each of the given variance: for many points its square is 6/5 of variance/steps.
double random_walk_slope(double variance, double steps) {
  return std::sqrt(1.2 * variance / steps);
}

}  // namespace

// Both widths together: the scatter about the line shows little of a random walk.
bool EnergyTrend::any() const { return !(std::abs(slope) <= half_width + rounding); }

EnergyTrend free_flight_trend(const Problem& problem, Stepper& stepper, std::int64_t steps,
                              int batches, int samples) {
  if (!problem.walls.empty()) throw std::invalid_argument("a free flight has no walls");
  if (batches < 3 || samples < 1 || steps < std::int64_t{batches} * samples) {
    throw std::invalid_argument("a trend needs three batches, and a step a sample");
  }
  Ledger ledger(problem);
  const std::int64_t first = stepper.step();
  double start = 0.0, variance = 0.0;
  const auto look = [&] {
    const State state = stepper.state();
    const Sample sample = measure(problem, state);
    const Inspection here = inspect(problem, state, sample);
    ledger.add(stepper.step(), state, sample);
    variance = std::max(variance, here.step.energy.variance);
    return sample.total() + here.swing - start;
  };
  start = look();
  std::vector<double> times, energies;
  const std::int64_t count = std::int64_t{batches} * samples;
  for (int b = 0; b < batches; ++b) {
    CompensatedSum time, energy;
    for (int s = 0; s < samples; ++s) {
      const std::int64_t target = first + steps / count * (std::int64_t{b} * samples + s + 1);
      stepper.advance(target - stepper.step());
      time.add(static_cast<double>(stepper.step() - first));
      energy.add(look());
    }
    times.push_back(time.value() / samples);
    energies.push_back(energy.value() / samples);
  }
  EnergyTrend trend;
  trend.steps = stepper.step() - first;
  double offset = 0.0, offset_variance = 0.0, covariance = 0.0, slope_variance = 0.0, scatter = 0.0;
  gsl_fit_linear(times.data(), 1, energies.data(), 1, times.size(), &offset, &trend.slope,
                 &offset_variance, &covariance, &slope_variance, &scatter);
  trend.half_width = gsl_cdf_tdist_Pinv(confidence, batches - 2) * std::sqrt(slope_variance);
  trend.rounding = gsl_cdf_ugaussian_Pinv(confidence) *
                   random_walk_slope(variance, static_cast<double>(trend.steps));
  trend.ledger = ledger.report();
  return trend;
}

}  // namespace bounce
