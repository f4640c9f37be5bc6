#include "kernels/plan/memory.hpp"

#include <algorithm>

#include "kernels/model/ball.hpp"
#include "kernels/contact/located.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

constexpr double state_bytes = 4.0 * sizeof(double);  // a particle

}  // namespace

double solver_bytes(const Scene& scene, const std::string& kernel) {
  const BallSize size = ball_size(scene.ball);
  double most = 0.0;
  bool known = false;
  for (const KernelEntry& entry : kernels()) {
    const auto bytes = static_cast<double>(size.particles) * entry.memory.a_particle +
                       static_cast<double>(size.entries) * entry.memory.an_entry;
    if (entry.name == kernel) {
      most = bytes;
      known = true;
    } else if (!known) {
      most = std::max(most, bytes);
    }
  }
  // Of located contact, beside the kernel: bonds, some states, what is held of a step.
  constexpr double located_bytes = 300.0;
  if (is_located(scene.walls)) most += static_cast<double>(size.particles) * located_bytes;
  return static_cast<double>(size.particles) * state_bytes + static_cast<double>(size.list_bytes) +
         most;
}

}  // namespace bounce
