#include "kernels/model/wall_rule.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/model/problem.hpp"

namespace bounce {

Motion after_wall(const Wall& wall, double drift, const Motion& behind) {
  const Vec2 n = wall.normal, v = behind.velocity, x = behind.position;
  const double s = wall_distance(wall, x.x, x.y);
  const double normal = n.x * v.x + n.y * v.y;
  const Vec2 t{v.x - normal * n.x, v.y - normal * n.y};
  const bool resolved = wall.contact != Contact::listing;
  double alpha = wall.alpha;
  double lift = 2.0 * s, back = 0.0;
  if (resolved) {
    const double slack = resting_slack * (std::abs(x.x) + std::abs(x.y) + std::abs(wall.offset));
    const bool resting = wall.beta == 0.0 && alpha < 1.0 && s - drift * normal <= slack;
    if (resting) alpha = 0.0;
    const double part = s / (drift * normal);
    lift = (1.0 - wall.beta) * s;
    back = part > 0.0 ? std::min(part, most_part_behind) * drift * (alpha - 1.0) : 0.0;
  }
  return {{x.x - lift * n.x + back * t.x, x.y - lift * n.y + back * t.y},
          {alpha * t.x + wall.beta * normal * n.x, alpha * t.y + wall.beta * normal * n.y}};
}

bool any_resolved(const std::vector<Wall>& walls) {
  return std::any_of(walls.begin(), walls.end(),
                     [](const Wall& wall) { return wall.contact != Contact::listing; });
}

}  // namespace bounce
