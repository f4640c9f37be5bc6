#include "driver/scene/memory_check.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
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

// The number behind `name` in a file of the kernel's, or `otherwise`.
double number_in(const char* path, const std::string& name, double otherwise) {
  std::ifstream file(path);
  std::string word;
  double value = 0.0;
  while (file >> word) {
    if (word == name && file >> value) return value;
  }
  return otherwise;
}

double only_number_in(const char* path, double otherwise) {
  std::ifstream file(path);
  double value = 0.0;
  return file >> value ? value : otherwise;  // "max" is no number
}

}  // namespace

double available_memory() {
  constexpr double endless = std::numeric_limits<double>::infinity();
  double bytes = 1024.0 * number_in("/proc/meminfo", "MemAvailable:", endless);
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const double taken = 1024.0 * number_in("/proc/self/status", "VmSize:", 0.0);
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur) - taken);
  }
  const double group = only_number_in("/sys/fs/cgroup/memory.max", endless);
  const double taken = only_number_in("/sys/fs/cgroup/memory.current", 0.0) -
                       number_in("/sys/fs/cgroup/memory.stat", "file", 0.0);  // can be dropped
  return std::max(0.0, std::min(bytes, group - std::max(0.0, taken)));
}

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
