#include "verify/figures/ball_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bounce {
namespace {

constexpr std::size_t lanes = 4;
using Lanes = std::array<double, lanes>;

double sum_of(const Lanes& parts) { return (parts[0] + parts[1]) + (parts[2] + parts[3]); }
double largest_of(const Lanes& parts) { return *std::max_element(parts.begin(), parts.end()); }

// Calls each(lane, i) for first ... end - 1, lane by lane.
template <class Each>
void in_lanes(std::size_t first, std::size_t end, const Each& each) {
  std::size_t i = first;
  for (; i + lanes <= end; i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) each(lane, i + lane);
  }
  for (std::size_t lane = 0; i < end; ++i, ++lane) each(lane, i);
}

void look_at_motion(const State& s, BallLook& look) {
  Lanes x{}, y{}, vx{}, vy{}, fastest{}, farthest{};
  const double x0 = s.x[0], y0 = s.y[0], vx0 = s.vx[0], vy0 = s.vy[0];
  in_lanes(0, s.size(), [&](std::size_t lane, std::size_t i) {
    x[lane] += s.x[i] - x0;
    y[lane] += s.y[i] - y0;
    vx[lane] += s.vx[i] - vx0;
    vy[lane] += s.vy[i] - vy0;
    fastest[lane] = std::max(fastest[lane], s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i]);
    farthest[lane] = std::max(farthest[lane], std::max(std::abs(s.x[i]), std::abs(s.y[i])));
  });
  const auto n = static_cast<double>(s.size());
  look.centre = {x0 + sum_of(x) / n, y0 + sum_of(y) / n};
  look.velocity = {vx0 + sum_of(vx) / n, vy0 + sum_of(vy) / n};
  look.fastest = std::sqrt(largest_of(fastest));
  look.farthest = largest_of(farthest);
}

// Half the difference of the principal squared axes, and half their sum.
struct Axes {
  double mean, half_gap;
};
Axes axes_of(const Moments& m) {
  return {0.5 * (m.xx + m.yy), std::hypot(0.5 * (m.xx - m.yy), m.xy)};
}

double rate_of(const Moments& m, const Moments& rate) {
  const Axes axes = axes_of(m);
  const double mean_rate = 0.5 * (rate.xx + rate.yy);
  const double gap_rate =
      axes.half_gap > 0.0
          ? (0.25 * (m.xx - m.yy) * (rate.xx - rate.yy) + m.xy * rate.xy) / axes.half_gap
          : 0.0;
  const double longer = axes.mean + axes.half_gap, shorter = axes.mean - axes.half_gap;
  if (!(shorter > 0.0)) return 0.0;
  return 0.5 * std::sqrt(shorter / longer) *
         ((mean_rate + gap_rate) / longer - (mean_rate - gap_rate) / shorter);
}

void look_at_shape(const State& s, std::size_t first, BallLook& look) {
  Lanes x{}, y{}, u{}, v{}, xx{}, xy{}, yy{}, xu{}, xv{}, yu{}, yv{};
  const double x0 = look.centre.x, y0 = look.centre.y;
  const double u0 = look.velocity.x, v0 = look.velocity.y;
  in_lanes(first, s.size(), [&](std::size_t lane, std::size_t i) {
    const double dx = s.x[i] - x0, dy = s.y[i] - y0, du = s.vx[i] - u0, dv = s.vy[i] - v0;
    x[lane] += dx;
    y[lane] += dy;
    u[lane] += du;
    v[lane] += dv;
    xx[lane] += dx * dx;
    xy[lane] += dx * dy;
    yy[lane] += dy * dy;
    xu[lane] += dx * du;
    xv[lane] += dx * dv;
    yu[lane] += dy * du;
    yv[lane] += dy * dv;
  });
  const auto n = static_cast<double>(s.size() - first);
  const double mx = sum_of(x) / n, my = sum_of(y) / n, mu = sum_of(u) / n, mv = sum_of(v) / n;
  const Moments gyration{sum_of(xx) / n - mx * mx, sum_of(xy) / n - mx * my,
                         sum_of(yy) / n - my * my};
  const Moments rate{2.0 * (sum_of(xu) / n - mx * mu),
                     sum_of(xv) / n + sum_of(yu) / n - mx * mv - my * mu,
                     2.0 * (sum_of(yv) / n - my * mv)};
  look.flattening = flattening_of(gyration);
  look.flattening_rate = rate_of(gyration, rate);
  look.radius = std::sqrt(gyration.xx + gyration.yy);
}

}  // namespace

bool BallLook::is_finite() const {
  return std::isfinite(centre.x + centre.y) && std::isfinite(velocity.x + velocity.y) &&
         std::isfinite(flattening + flattening_rate);
}

double flattening_of(const Moments& gyration) {
  const Axes axes = axes_of(gyration);
  const double longer = axes.mean + axes.half_gap;
  // 1 - sqrt(q) = (1 - q)/(1 + sqrt q), q the ratio of the squared axes. A straight line of points
  // may round to a squared axis just below zero.
  const double missing = std::min(2.0 * axes.half_gap / longer, 1.0);
  return std::isnan(longer) ? longer : missing / (1.0 + std::sqrt(1.0 - missing));
}

BallLook look_at(const Model& model, const State& state) {
  BallLook look;
  if (state.size() == 0) return look;
  look_at_motion(state, look);
  const auto& rings = model.bonds.rings();
  look_at_shape(state, rings ? state.size() - static_cast<std::size_t>(rings->per_ring) : 0, look);
  for (const Wall& wall : model.walls) {
    Lanes nearest;
    nearest.fill(std::numeric_limits<double>::infinity());
    in_lanes(0, state.size(), [&](std::size_t lane, std::size_t i) {
      nearest[lane] =
          std::min(nearest[lane], wall.normal.x * state.x[i] + wall.normal.y * state.y[i]);
    });
    look.nearest.push_back(*std::min_element(nearest.begin(), nearest.end()) - wall.offset);
  }
  return look;
}

}  // namespace bounce
