#include "driver/scene/memory_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "kernels/model/ball.hpp"
#include "kernels/plan/memory.hpp"

namespace bounce {
namespace {

// Beside the solver a run holds, per particle: the last good state, the state looked at and the one
// to become the last good one (32 bytes each), and while it looks what the ledgers want to know of
// each particle (96 bytes).
constexpr double looking_bytes = 3 * 32.0 + 96.0;
// The program itself, its threads and buffers.
constexpr double program_bytes = 64e6;

}  // namespace

double run_bytes(const Scene& scene, const std::string& kernel) {
  const auto particles = static_cast<double>(ball_size(scene.ball).particles);
  return solver_bytes(scene, kernel) + particles * looking_bytes + program_bytes;
}

void check_memory(const SceneFile& file, const std::string& kernel, double available) {
  const Scene scene = file.scene();
  const double needed = run_bytes(scene, kernel);
  if (needed <= available) return;
  const auto particles = static_cast<double>(ball_size(scene.ball).particles);
  const double each = (needed - program_bytes) / particles;
  const double most = std::max(0.0, (available - program_bytes) / each);
  const bool has_rings = scene.ball.kind == BallKind::rings;
  throw file.explain(SceneError(
      has_rings ? "ball.per_ring" : "ball.spacing",
      has_rings ? fmt::format("{}", scene.ball.per_ring) : fmt::format("{}", *scene.ball.spacing),
      fmt::format("a ball of at most {:.3g} particles: this one has {:.3g}, a run takes {:.3g} GB "
                  "({:.0f} bytes a particle), and {:.3g} GB of memory are free",
                  std::floor(most), particles, needed / 1e9, each, available / 1e9)));
}

void check_path_memory(std::size_t particles, double times) {
  constexpr double most = 2e9;  // bytes
  const double bytes = 3.0 * 32.0 * static_cast<double>(particles) * times;
  if (!(bytes <= most)) {
    throw InputError(
        fmt::format("--every: {} particles at {:.6g} times would take {:.1f} GB; allowed are 2 (a "
                    "larger --every takes less)",
                    particles, times, bytes * 1e-9));
  }
}

}  // namespace bounce
