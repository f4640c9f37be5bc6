#include "verify/accuracy/reference_solution.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "verify/vibrations/spectrum.hpp"

namespace bounce {

std::string_view name_of(ContactKind kind) {
  switch (kind) {
    case ContactKind::lands:
      return "lands";
    case ContactKind::bounces:
      return "bounces";
    case ContactKind::releases:
      break;
  }
  return "releases";
}

void check_output_times(std::span<const double> times) {
  double before = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const bool in_order = k == 0 ? times[k] >= 0.0 : times[k] > before;
    if (!in_order || !std::isfinite(times[k])) {
      throw std::invalid_argument("output times of a reference must increase, from 0 on");
    }
    before = times[k];
  }
}

double reference_frequency(const Problem& problem) {
  const auto fastest = fastest_vibration(problem, problem.initial);
  if (!fastest) {
    throw ReferenceError("the start has a bond whose stiffness is not finite: nothing to solve");
  }
  return fastest->omega;
}

double default_reference_step(const Problem& problem) {
  constexpr double without_vibration = 1e-3;  // s
  const double omega = reference_frequency(problem);
  return omega > 0.0 ? 0.25 / omega : without_vibration;
}

State disturbed_start(const Problem& problem, double size) {
  State state = problem.initial;
  std::mt19937_64 random(1);
  // Not std::uniform_real_distribution, which may differ from library to library.
  const auto next = [&random, size] {
    return size * (2.0 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1.0);
  };
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double dx = next(), dy = next();
    const auto stays_in_front = [&](const Wall& wall) {
      return wall_distance(wall, state.x[i] + dx, state.y[i] + dy) > 0.0;
    };
    if (!std::all_of(problem.walls.begin(), problem.walls.end(), stays_in_front)) continue;
    state.x[i] += dx;
    state.y[i] += dy;
  }
  return state;
}

double largest_distance(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double distance = std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]);
    if (!(distance <= largest)) largest = distance;
    if (std::isnan(distance)) break;
  }
  return largest;
}

}  // namespace bounce
