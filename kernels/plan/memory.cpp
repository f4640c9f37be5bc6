#include "kernels/plan/memory.hpp"

#include <algorithm>

#include "kernels/model/ball.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

constexpr double state_bytes = 4.0 * sizeof(double);  // a particle

}  // namespace

double solver_bytes(const Scene& scene, const std::string& kernel) {
  const BallSize size = ball_size(scene.ball);
  double most = 0.0, on_top = 0.0;
  bool known = false;
  for (const KernelEntry& entry : kernels()) {
    const auto bytes = static_cast<double>(size.particles) * entry.memory.a_particle +
                       static_cast<double>(size.entries) * entry.memory.an_entry;
    if (entry.wraps) {
      if (entry.has_contacts_of(scene.walls)) on_top = std::max(on_top, bytes);
    } else if (entry.name == kernel) {
      most = bytes;
      known = true;
    } else if (!known) {
      most = std::max(most, bytes);
    }
  }
  return static_cast<double>(size.particles) * state_bytes + static_cast<double>(size.list_bytes) +
         most + on_top;
}

}  // namespace bounce
