#include "verify/figures/shape.hpp"

#include <Eigen/Core>
#include <limits>
#include <stdexcept>
#include <string>

#include "verify/figures/ball_look.hpp"

namespace bounce {
namespace {

using Points = Eigen::Map<const Eigen::ArrayXd>;

Points points(const std::vector<double>& values, std::size_t first, std::size_t count) {
  return {values.data() + first, static_cast<Eigen::Index>(count)};
}

double flattening(const Points& x, const Points& y) {
  const Eigen::ArrayXd dx = x - x.mean();
  const Eigen::ArrayXd dy = y - y.mean();
  return flattening_of({dx.square().mean(), (dx * dy).mean(), dy.square().mean()});
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

}  // namespace bounce
