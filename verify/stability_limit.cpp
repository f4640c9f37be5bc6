#include "verify/stability_limit.hpp"

#include <cmath>
#include <limits>

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

double stability_limit(std::span<const Stage> stages) {
  // The trace is a polynomial in z of degree twice the number of stages: on a grid as fine as this
  // a maximum between two points shows as a point that is not below its neighbours. It is then
  // looked at closely, so that an unstable window narrower than the grid is not stepped over.
  constexpr double grid = 1e-3;
  const double end = 2.0 * static_cast<double>(stages.size()) + 0.5;
  double before = 1.0;
  double here = half_trace(stages, grid);
  if (outside(here)) return edge_between(stages, 0.0, grid);
  for (int k = 1; k * grid < end; ++k) {
    const double z = k * grid;
    const double after = half_trace(stages, z + grid);
    if (here >= before && here >= after) {
      const double peak = peak_between(stages, z - grid, z + grid);
      if (outside(half_trace(stages, peak))) return edge_between(stages, z - grid, peak);
    }
    if (outside(after)) return edge_between(stages, z, z + grid);
    before = here;
    here = after;
  }
  return std::numeric_limits<double>::infinity();
}

double stability_limit(const Method& method) { return stability_limit(method.stages); }

double stable_step(const Method& method, double omega) { return stability_limit(method) / omega; }

}  // namespace bounce
