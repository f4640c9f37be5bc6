#include "verify/vibrations/stability_limit.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace bounce {
namespace {

// What rounding in the products, and coefficients given to seven digits, may add to |trace|/2 where
// it only touches 1. A step that leaves by no more than this grows by at most sqrt(2e-12) a step.
constexpr double touch = 1e-12;

// A NaN is outside.
bool outside(double half) { return !(half <= 1.0 + touch); }

// Where |trace|/2 passes 1 between a stable z and an unstable one.
double edge_between(std::span<const Stage> stages, double stable, double unstable) {
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (stable + unstable);
    (half_trace(stages, middle) <= 1.0 ? stable : unstable) = middle;
  }
  return stable;
}

// The z of the largest |trace| between lo and hi, within which there is one maximum: ternary
// search.
double peak_between(std::span<const Stage> stages, double lo, double hi) {
  for (int third = 0; third < 60; ++third) {
    const double a = lo + (hi - lo) / 3.0;
    const double b = hi - (hi - lo) / 3.0;
    if (half_trace(stages, a) < half_trace(stages, b)) {
      lo = a;
    } else {
      hi = b;
    }
  }
  return 0.5 * (lo + hi);
}

/// Goes up z, from 0 to beyond what any method bears, and collects unstable windows.
class WindowSearch {
 public:
  WindowSearch(std::span<const Stage> stages, std::size_t most) : stages_(stages), most_(most) {}

  std::vector<UnstableWindow> run() {
    // The trace is a polynomial in z of degree twice the number of stages: on a grid as fine as
    // this a maximum between two points shows as a point that is not below its neighbours. It is
    // then looked at closely, so that an unstable window narrower than the grid is not stepped
    // over.
    constexpr double grid = 1e-3;
    const double end = 2.0 * static_cast<double>(stages_.size()) + 0.5;
    double before = 1.0;
    double here = half_trace(stages_, grid);
    for (int k = 1; k * grid < end && found_.size() < most_; ++k) {
      const double z = k * grid;
      const double after = half_trace(stages_, z + grid);
      const bool top = here >= before && here >= after;
      const double peak = top ? peak_between(stages_, z - grid, z + grid) : z;
      if (peak < z) look(peak);
      look(z);
      if (peak > z) look(peak);
      before = here;
      here = after;
    }
    if (open_) close(last_);
    return found_;
  }

 private:
  // Looks are taken in the order of z.
  void look(double z) {
    const bool bad = outside(half_trace(stages_, z));
    if (bad && !open_) {
      open_ = UnstableWindow{edge_between(stages_, last_, z), z, z, 0.0};
    }
    if (!bad && open_) close(edge_between(stages_, z, last_));
    if (bad) {
      const double growth = growth_per_period(stages_, z);
      if (growth > open_->growth) {
        open_->growth = growth;
        open_->worst = z;
      }
    }
    last_ = z;
  }
  void close(double to) {
    open_->to = to;
    found_.push_back(*open_);
    open_.reset();
  }

  std::span<const Stage> stages_;
  std::size_t most_;
  double last_ = 0.0;
  std::optional<UnstableWindow> open_;
  std::vector<UnstableWindow> found_;
};

}  // namespace

double half_trace(std::span<const Stage> stages, double z) {
  // Images of (1, 0) and (0, 1). Extended precision: near the edge of a method of many stages large
  // terms cancel.
  long double x1 = 1.0L, v1 = 0.0L, x2 = 0.0L, v2 = 1.0L;
  for (const Stage& stage : stages) {
    const long double kick = static_cast<long double>(stage.kick) * z;
    const long double drift = static_cast<long double>(stage.drift) * z;
    v1 -= kick * x1;
    v2 -= kick * x2;
    x1 += drift * v1;
    x2 += drift * v2;
  }
  return static_cast<double>(std::abs(x1 + v2) / 2.0L);
}

double growth_per_period(std::span<const Stage> stages, double z) {
  const double beyond = half_trace(stages, z) - 1.0;
  if (!std::isfinite(beyond)) return std::numeric_limits<double>::infinity();
  if (beyond <= touch) return 0.0;
  // ln(m + sqrt(m^2 - 1)) a step for x and v, twice that for the energy.
  const double a_step = std::log1p(beyond + std::sqrt(beyond * (2.0 + beyond)));
  return 2.0 * a_step * 2.0 * std::numbers::pi / z;
}

std::vector<UnstableWindow> unstable_windows(std::span<const Stage> stages) {
  return WindowSearch(stages, std::numeric_limits<std::size_t>::max()).run();
}

std::optional<double> first_growing(std::span<const Stage> stages, const UnstableWindow& window,
                                    double growth) {
  if (!(window.growth > growth)) return std::nullopt;
  double below = window.from, above = window.worst;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (below + above);
    (growth_per_period(stages, middle) > growth ? above : below) = middle;
  }
  return above;
}

double stability_limit(std::span<const Stage> stages) {
  const auto first = WindowSearch(stages, 1).run();
  return first.empty() ? std::numeric_limits<double>::infinity() : first.front().from;
}

double stability_limit(const Method& method) { return stability_limit(method.stages); }

double stable_step(const Method& method, double omega) { return stability_limit(method) / omega; }

}  // namespace bounce
