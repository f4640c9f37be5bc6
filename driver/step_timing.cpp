#include "driver/step_timing.hpp"

#include <algorithm>
#include <chrono>

namespace bounce {
namespace {

double seconds_of(Stepper& stepper, const Snapshot& start, std::int64_t steps) {
  stepper.restore(start);
  const auto begin = std::chrono::steady_clock::now();
  stepper.advance(steps);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

std::vector<double> time_steps(std::span<Stepper* const> steppers, int turns, double slice) {
  std::vector<Snapshot> starts;
  std::vector<std::int64_t> steps;
  for (Stepper* const stepper : steppers) {
    starts.push_back(stepper->save());
    std::int64_t count = 16;
    while (seconds_of(*stepper, starts.back(), count) < slice) count *= 2;
    steps.push_back(count);
  }
  std::vector<std::vector<double>> times(steppers.size());
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < steppers.size(); ++i) {
      const double seconds = seconds_of(*steppers[i], starts[i], steps[i]);
      times[i].push_back(seconds / static_cast<double>(steps[i]));
    }
  }
  std::vector<double> medians;
  for (std::size_t i = 0; i < steppers.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    medians.push_back(times[i][times[i].size() / 2]);
    steppers[i]->restore(starts[i]);
  }
  return medians;
}

}  // namespace bounce
