#include "verify/accuracy/course.hpp"

#include <algorithm>
#include <cmath>

#include "verify/watch/observables.hpp"

namespace bounce {
namespace {

// Distance of the nearest particle from a wall, cm; infinite without walls.
double nearest_distance(const Problem& problem, const State& state) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : problem.walls) {
    for (std::size_t i = 0; i < state.size(); ++i) {
      nearest = std::min(nearest, wall_distance(wall, state.x[i], state.y[i]));
    }
  }
  return nearest;
}

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

CourseGauge::CourseGauge(const Problem& problem, int rings, std::optional<std::size_t> free_samples)
    : problem_(&problem), rings_(rings), find_contact_(!free_samples) {
  record_.free_samples = free_samples.value_or(0);
}

bool CourseGauge::add(double time, const State& state) {
  record_.finite = record_.finite && is_finite(state);
  if (!record_.finite) return false;
  const Sample sample = measure(*problem_, state);
  record_.finite = std::isfinite(sample.total());
  if (!record_.finite) return false;
  const double nearest = nearest_distance(*problem_, state);
  Observables& o = record_.observables;
  if (!any_) {
    start_energy_ = sample.total();
    o.contact = o.flattening = 0.0;
  } else {
    add_contact(time, nearest);
  }
  record_.energy.push_back(sample.total());
  keep_states(state, sample, time, nearest);
  o.height = sample.centre.y;
  o.speed = std::hypot(sample.momentum.x, sample.momentum.y) / static_cast<double>(state.size());
  o.lost = start_energy_ - sample.total();
  const Shape shape = rings_ == 0 ? measure_shape(state) : measure_shape(state, rings_);
  o.flattening = largest(o.flattening, shape.flattening);
  last_time_ = time;
  last_nearest_ = nearest;
  any_ = true;
  return true;
}

// The part of the interval in which the nearest particle, on a straight way between the samples, is
// within contact_distance: unlike a count of samples it changes little where the course does.
void CourseGauge::add_contact(double time, double nearest) {
  const double above = nearest - contact_distance, above_before = last_nearest_ - contact_distance;
  const double low = std::min(above, above_before), high = std::max(above, above_before);
  const double part = high <= 0.0 ? 1.0 : low >= 0.0 ? 0.0 : -low / (high - low);
  record_.observables.contact += part * (time - last_time_);
}

void CourseGauge::keep_states(const State& state, const Sample& sample, double time,
                              double nearest) {
  const std::size_t samples = record_.energy.size();
  if (find_contact_) {
    touched_ = touched_ || nearest <= contact_distance;
    if (!touched_) record_.free_samples = samples;
  }
  if (samples == record_.free_samples) record_.before = state;
  if (!any_ || sample.centre.y < lowest_) {
    lowest_ = sample.centre.y;
    record_.lowest_time = time;
    record_.observables.rebound = lowest_;
  }
  record_.observables.rebound = std::max(record_.observables.rebound, sample.centre.y);
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
