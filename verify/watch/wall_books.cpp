#include "verify/watch/wall_books.hpp"

namespace bounce {

std::int64_t WallBooks::reflections() const {
  std::int64_t sum = 0;
  for (const WallBook& wall : walls) sum += wall.reflections;
  return sum;
}

double WallBooks::energy_given() const {
  CompensatedSum sum;
  for (const WallBook& wall : walls) {
    sum.add(wall.kinetic.value());
    sum.add(wall.gravity.value());
    sum.add(wall.bond.value());
  }
  return sum.value();
}

Vec2 WallBooks::impulse() const {
  CompensatedSum x, y;
  for (const WallBook& wall : walls) {
    x.add(wall.impulse_x.value());
    y.add(wall.impulse_y.value());
  }
  return {x.value(), y.value()};
}

double WallBooks::torque() const {
  CompensatedSum sum;
  for (const WallBook& wall : walls) sum.add(wall.torque.value());
  return sum.value();
}

}  // namespace bounce
