#include "verify/accuracy/reference_pair.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <future>
#include <limits>
#include <mutex>
#include <utility>

#include "verify/figures/contact_gauge.hpp"

namespace bounce {
namespace {

// What ends a solution whose companion has failed.
struct Abandoned {};

// Several solutions that end together: one that fails ends the others at their next output time,
// and its exception is the one that comes out.
class Together {
 public:
  Together(const ReferenceTick& tick, const ReferenceKeeper& keeper)
      : tick_(tick), keeper_(keeper) {}

  template <class Solve>
  ReferencePath follow(const std::string& name, const Problem& problem, std::size_t outputs,
                       const Solve& solve) {
    ReferencePath path;
    if (keeper_.find) {
      if (auto kept = keeper_.find(name)) return std::move(*kept);
    }
    ContactGauge gauge(problem);
    path.states.reserve(outputs);
    try {
      const ReferenceVisitor visit = [&](double, const State& state) {
        if (failed_.load()) throw Abandoned{};
        path.states.push_back(state);
        if (tick_) tick_();
      };
      path.run = solve(visit, &gauge);
      path.bounce = gauge.result();
      if (keeper_.keep) keeper_.keep(name, path);
    } catch (const Abandoned&) {
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
    return path;
  }
  /// After all have ended.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  const ReferenceTick& tick_;
  const ReferenceKeeper& keeper_;
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

// The pair, and after the adaptive solution, on its thread, `more`.
template <class More>
ReferencePair solve_pair(const Problem& problem, std::span<const double> times,
                         const ReferenceSettings& settings, const ReferenceTick& tick,
                         const ReferenceKeeper& keeper, const More& more) {
  Together together(tick, keeper);
  auto fixed = std::async(std::launch::async, [&] {
    return together.follow("fixed", problem, times.size(),
                           [&](const ReferenceVisitor& visit, ContactWatch* watch) {
                             return solve_fixed(problem, times, settings.fixed, visit, watch);
                           });
  });
  ReferencePair pair;
  pair.times.assign(times.begin(), times.end());
  pair.adaptive = together.follow(
      "adaptive", problem, times.size(), [&](const ReferenceVisitor& visit, ContactWatch* watch) {
        return solve_adaptive(problem, times, settings.adaptive, visit, watch);
      });
  more(together);
  pair.fixed = fixed.get();
  together.rethrow();
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
  return solve_pair(problem, times, settings, tick, {}, [](Together&) {});
}

DisturbedPair solve_disturbed(const Problem& problem, std::span<const double> times,
                              const ReferenceSettings& settings, double disturbance,
                              const ReferenceTick& tick, const ReferenceKeeper& keeper) {
  DisturbedPair both;
  both.pair = solve_pair(problem, times, settings, tick, keeper, [&](Together& together) {
    Problem moved = problem;
    moved.initial = disturbed_start(problem, disturbance);
    both.disturbed = together.follow(
        "disturbed", moved, times.size(), [&](const ReferenceVisitor& visit, ContactWatch* watch) {
          return solve_adaptive(moved, times, settings.adaptive, visit, watch);
        });
  });
  return both;
}

double rounding_disturbance(const Problem& problem) {
  double largest = 0.0;
  for (std::size_t i = 0; i < problem.initial.size(); ++i) {
    largest = std::max({largest, std::abs(problem.initial.x[i]), std::abs(problem.initial.y[i])});
  }
  return 8.0 * std::numeric_limits<double>::epsilon() * largest;
}

Growth growth_of(const DisturbedPair& paths) {
  const ReferencePair& pair = paths.pair;
  Growth growth;
  for (std::size_t k = 0; k < pair.times.size(); ++k) {
    const double distance = largest_distance(pair.adaptive.states[k], paths.disturbed.states[k]);
    if (k == 0) growth.start = distance;
    if (k == pair.last_before_contact()) growth.contact = distance;
    if (distance > growth.greatest || std::isnan(distance)) growth.greatest = distance;
    growth.end = distance;
  }
  const double time = pair.times.back() - pair.times[pair.last_before_contact()];
  growth.rate = time > 0.0 ? std::log(growth.end / growth.contact) / time
                           : std::numeric_limits<double>::quiet_NaN();
  return growth;
}

}  // namespace bounce
