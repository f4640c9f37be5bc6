#include "verify/reference_pair.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>

namespace bounce {
namespace {

template <class Solve>
ReferencePath follow(std::size_t outputs, const ReferenceTick& tick, const Solve& solve) {
  ReferencePath path;
  path.states.reserve(outputs);
  path.run = solve([&](double, const State& state) {
    path.states.push_back(state);
    if (tick) tick();
  });
  return path;
}

// The pair, and after the adaptive solution, on its thread, `more`.
template <class More>
ReferencePair solve_pair(const Problem& problem, std::span<const double> times,
                         const ReferenceSettings& settings, const ReferenceTick& tick,
                         const More& more) {
  auto fixed = std::async(std::launch::async, [&] {
    return follow(times.size(), tick, [&](const ReferenceVisitor& visit) {
      return solve_fixed(problem, times, settings.fixed, visit);
    });
  });
  ReferencePair pair;
  pair.times.assign(times.begin(), times.end());
  // If this throws, the future waits for the other one as it goes.
  pair.adaptive = follow(times.size(), tick, [&](const ReferenceVisitor& visit) {
    return solve_adaptive(problem, times, settings.adaptive, visit);
  });
  more();
  pair.fixed = fixed.get();
  return pair;
}

}  // namespace

double ReferencePair::first_contact() const {
  double first = times.empty() ? 0.0 : times.back();
  for (const ReferencePath* path : {&adaptive, &fixed}) {
    if (!path->run.events.empty()) first = std::min(first, path->run.events.front().time);
  }
  return first;
}

std::size_t ReferencePair::last_before_contact() const {
  const auto after = std::lower_bound(times.begin(), times.end(), first_contact());
  const bool none = adaptive.run.events.empty() && fixed.run.events.empty();
  if (none) return times.empty() ? 0 : times.size() - 1;
  return after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
}

ReferencePair solve_both(const Problem& problem, std::span<const double> times,
                         const ReferenceSettings& settings, const ReferenceTick& tick) {
  return solve_pair(problem, times, settings, tick, [] {});
}

DisturbedPair solve_disturbed(const Problem& problem, std::span<const double> times,
                              const ReferenceSettings& settings, double disturbance,
                              const ReferenceTick& tick) {
  DisturbedPair both;
  both.pair = solve_pair(problem, times, settings, tick, [&] {
    Problem moved = problem;
    moved.initial = disturbed_start(problem, disturbance);
    both.disturbed = follow(times.size(), tick, [&](const ReferenceVisitor& visit) {
      return solve_adaptive(moved, times, settings.adaptive, visit);
    });
  });
  return both;
}

Growth growth_of(const DisturbedPair& paths) {
  const ReferencePair& pair = paths.pair;
  Growth growth;
  for (std::size_t k = 0; k < pair.times.size(); ++k) {
    const double distance = largest_distance(pair.adaptive.states[k], paths.disturbed.states[k]);
    if (k == 0) growth.start = distance;
    if (k == pair.last_before_contact()) growth.contact = distance;
    if (!(distance <= growth.greatest)) growth.greatest = distance;
    growth.end = distance;
  }
  const double time = pair.times.back() - pair.times[pair.last_before_contact()];
  growth.rate = time > 0.0 ? std::log(growth.end / growth.contact) / time
                           : std::numeric_limits<double>::quiet_NaN();
  return growth;
}

}  // namespace bounce
