#include "verify/accuracy/course.hpp"

#include <algorithm>
#include <cmath>

namespace bounce {
namespace {

// Either, if it is not a number.
double largest(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

double largest_distance(const State& a, const State& b) {
  double found = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    found = largest(found, std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]));
  }
  return found;
}

CourseErrors all_infinite() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CourseErrors errors{{}, infinity, infinity, infinity};
  for (const ObservableName& each : observable_names) errors.observables.*each.value = infinity;
  return errors;
}

}  // namespace

CourseGauge::CourseGauge(const Problem& problem, std::optional<std::size_t> free_samples)
    : problem_(&problem) {
  record_.free_samples = free_samples.value_or(0);
}

bool CourseGauge::add(const State& state) {
  record_.finite = record_.finite && is_finite(state);
  if (!record_.finite) return false;
  now_ = measure(*problem_, state);
  record_.finite = std::isfinite(now_.total());
  if (!record_.finite) return false;
  if (!start_) start_ = now_;
  record_.energy.push_back(now_.total());
  if (record_.energy.size() == record_.free_samples) record_.before = state;
  return true;
}

CourseRecord CourseGauge::result(Bounce bounce) const {
  CourseRecord record = record_;
  if (start_) bounce.energy_lost = energy_lost(*start_, now_);
  for (const ObservableName& each : observable_names) {
    const auto& figure = bounce.*each.figure;
    if (!figure) continue;
    record.observables.*each.value = figure->value;
    record.found_to.*each.value = figure->found_to;
  }
  if (bounce.lowest_centre_time) record.lowest_time = bounce.lowest_centre_time->value;
  return record;
}

CourseErrors errors_of(const CourseRecord& course, const CourseRecord& reference) {
  if (!course.finite || course.energy.size() != reference.energy.size()) return all_infinite();
  CourseErrors errors;
  errors.position = std::numeric_limits<double>::quiet_NaN();
  for (const ObservableName& each : observable_names) {
    errors.observables.*each.value =
        std::abs(course.observables.*each.value - reference.observables.*each.value);
  }
  if (course.before.size() == reference.before.size() && course.before.size() > 0) {
    errors.position = largest_distance(course.before, reference.before);
  }
  for (std::size_t s = 0; s < course.energy.size(); ++s) {
    errors.energy = largest(errors.energy, std::abs(course.energy[s] - reference.energy[s]));
    if (s >= reference.free_samples) continue;
    errors.energy_free =
        largest(errors.energy_free, std::abs(course.energy[s] - course.energy.front()));
  }
  return errors;
}

CourseErrors bar_of(const CourseRecord& course, const CourseRecord& reference) {
  CourseErrors bar = errors_of(course, reference);
  for (const ObservableName& each : observable_names) {
    for (const CourseRecord* record : {&course, &reference}) {
      double& size = bar.observables.*each.value;
      const double found_to = record->found_to.*each.value;
      if (size < found_to) size = found_to;  // a NaN stays
    }
  }
  return bar;
}

CourseErrors larger_of(const CourseErrors& a, const CourseErrors& b) {
  CourseErrors both{{},
                    largest(a.position, b.position),
                    largest(a.energy_free, b.energy_free),
                    largest(a.energy, b.energy)};
  for (const ObservableName& each : observable_names) {
    both.observables.*each.value = largest(a.observables.*each.value, b.observables.*each.value);
  }
  return both;
}

double error_or_bar(double error, double bar) {
  return error > bar ? error : std::isnan(error) ? error : bar;
}

}  // namespace bounce
