#include "verify/watch/observables.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace bounce {
namespace {

using Points = Eigen::Map<const Eigen::ArrayXd>;

Points points(const std::vector<double>& values, std::size_t first, std::size_t count) {
  return {values.data() + first, static_cast<Eigen::Index>(count)};
}

// 1 - ratio of the principal axes of the points' gyration tensor; 0 = round.
double flattening(const Points& x, const Points& y) {
  const Eigen::ArrayXd dx = x - x.mean();
  const Eigen::ArrayXd dy = y - y.mean();
  Eigen::Matrix2d gyration;
  gyration << dx.square().mean(), (dx * dy).mean(), (dx * dy).mean(), dy.square().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(gyration, Eigen::EigenvaluesOnly);
  const Eigen::Vector2d& squares = solver.eigenvalues();  // increasing
  // A straight line of points may round to a squared axis just below zero.
  return 1.0 - std::sqrt(std::max(squares[0], 0.0) / squares[1]);
}

// Without PropagateNaN Eigen may drop a NaN.
double extent(const Points& values) {
  return values.maxCoeff<Eigen::PropagateNaN>() - values.minCoeff<Eigen::PropagateNaN>();
}

// Signed area of a closed polygon, positive if it runs counter-clockwise.
double area(const Points& x, const Points& y) {
  double twice = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::Index next = i + 1 == x.size() ? 0 : i + 1;
    twice += (x[i] - x[0]) * (y[next] - y[0]) - (x[next] - x[0]) * (y[i] - y[0]);
  }
  return 0.5 * twice;
}

}  // namespace

Shape measure_shape(const State& state, int rings) {
  const std::size_t n = state.size();
  if (rings < 1 || n == 0 || n % static_cast<std::size_t>(rings) != 0) {
    throw std::invalid_argument(std::to_string(n) + " particles are not " + std::to_string(rings) +
                                " rings of one size");
  }
  const std::size_t per_ring = n / static_cast<std::size_t>(rings);
  const Points x = points(state.x, 0, n);
  const Points y = points(state.y, 0, n);
  const Points vx = points(state.vx, 0, n);
  const Points vy = points(state.vy, 0, n);
  const Eigen::ArrayXd dx = x - x.mean();
  const Eigen::ArrayXd dy = y - y.mean();
  Shape shape;
  shape.width = extent(x);
  shape.height = extent(y);
  shape.flattening =
      flattening(points(state.x, n - per_ring, per_ring), points(state.y, n - per_ring, per_ring));
  shape.enclosed = area(points(state.x, 0, per_ring), points(state.y, 0, per_ring));
  shape.spin = (dx * vy - dy * vx).sum() / (dx.square() + dy.square()).sum();
  return shape;
}

Shape measure_shape(const State& state) {
  Shape shape = measure_shape(state, 1);
  shape.enclosed = std::numeric_limits<double>::quiet_NaN();
  return shape;
}

void BounceGauge::add(double time, const Sample& sample) {
  const bool any = any_;
  const double interval = time - last_time_;
  add_sample(time, sample);
  const bool touches = sample.on_wall > 0;
  if (touches) {
    if (bounce_.first_contact < 0.0) bounce_.first_contact = time;
    bounce_.last_contact = time;
  }
  if (any) {
    const double ends = (touches ? 0.5 : 0.0) + (touched_ ? 0.5 : 0.0);
    bounce_.contact_time += ends * interval;
  }
  touched_ = touches;
}

void BounceGauge::add(double time, const Sample& sample, const Push& push) {
  const double before = last_time_;
  const bool any = any_;
  add_sample(time, sample);
  if (any && push.contact) {
    if (bounce_.first_contact < 0.0) bounce_.first_contact = before;
    bounce_.last_contact = time;
    bounce_.contact_time += time - before;
  }
  if (any) add_to_impact(sample, push);
  last_momentum_ = sample.momentum;
}

void BounceGauge::add_sample(double time, const Sample& sample) {
  if (!std::isfinite(time) || !std::isfinite(sample.total()) || !std::isfinite(sample.centre.y)) {
    throw std::invalid_argument("a sample of a bounce is not finite");
  }
  if (any_ && !(time > last_time_)) {
    throw std::invalid_argument("samples of a bounce are not in the order of time");
  }
  const double height = sample.centre.y;
  if (!any_ || height < bounce_.lowest_centre) {
    bounce_.lowest_centre = height;
    bounce_.lowest_centre_time = time;
    bounce_.rebound_height = height;
  }
  bounce_.rebound_height = std::max(bounce_.rebound_height, height);
  if (!any_) start_energy_ = sample.total();
  bounce_.energy_lost = start_energy_ - sample.total();
  last_time_ = time;
  any_ = true;
}

void BounceGauge::add_to_impact(const Sample& sample, const Push& push) {
  if (impact_over_ || !(impact_ || push.contact)) return;
  if (!impact_) arriving_ = last_momentum_;
  impact_ = true;
  impulse_ = {impulse_.x + push.impulse.x, impulse_.y + push.impulse.y};
  if (push.contact) leaving_ = sample.momentum;
  // Along the normal of the wall that pushed most.
  const auto pushed = [this](const Wall& wall) {
    return wall.normal.x * impulse_.x + wall.normal.y * impulse_.y;
  };
  const auto wall =
      std::max_element(walls_.begin(), walls_.end(),
                       [&pushed](const Wall& a, const Wall& b) { return pushed(a) < pushed(b); });
  if (wall == walls_.end()) return;
  const auto along = [&wall](Vec2 p) { return p.x * wall->normal.x + p.y * wall->normal.y; };
  const double in = -along(arriving_);
  const double out = along(leaving_);
  const double impulse = along(impulse_);
  constexpr double least_share = 0.01;
  const bool left = !push.contact && out > 0.0 && in > least_share * impulse;
  bounce_.restitution = left ? std::optional(out / in) : std::nullopt;
  impact_over_ = !push.contact && out > 0.0 && along(sample.momentum) < 0.0;
}

void BounceGauge::add_shape(double time, const Shape& shape) {
  if (!(shape.flattening <= bounce_.greatest_flattening)) {
    bounce_.greatest_flattening = shape.flattening;
    bounce_.greatest_flattening_time = time;
  }
}

}  // namespace bounce
