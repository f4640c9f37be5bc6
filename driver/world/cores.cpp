#include "driver/world/cores.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "kernels/stepping/threads.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

// The first number of a file; nothing if it is not there or begins with a word ("max").
std::optional<double> number_in(const fs::path& path) {
  std::ifstream file(path);
  double number = 0.0;
  return file >> number ? std::optional(number) : std::nullopt;
}

// Of one group: processor time over time.
double quota_of(const fs::path& group) {
  double quota = 0.0, period = 0.0;
  std::ifstream both(group / "cpu.max");
  if (!(both >> quota >> period)) {
    quota = number_in(group / "cpu.cfs_quota_us").value_or(-1.0);
    period = number_in(group / "cpu.cfs_period_us").value_or(0.0);
  }
  return quota > 0.0 && period > 0.0 ? quota / period : std::numeric_limits<double>::infinity();
}

// Of a group and all above it, up to where they are mounted.
double least_quota(const fs::path& mount, const std::string& name) {
  double least = quota_of(mount);
  fs::path group = mount;
  for (const fs::path& part : fs::path(name).relative_path()) {
    group /= part;
    least = std::min(least, quota_of(group));
  }
  return least;
}

}  // namespace

int cores_by_quota(const std::string& groups, const fs::path& root) {
  double least = std::numeric_limits<double>::infinity();
  std::istringstream lines(groups);
  for (std::string line; std::getline(lines, line);) {  // number:controllers:name
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string name = line.substr(second + 1);
    if (controllers.empty()) {
      least = std::min(least, least_quota(root, name));
    } else if (("," + controllers + ",").find(",cpu,") != std::string::npos) {
      for (const std::string& mount : {controllers, std::string("cpu")}) {
        least = std::min(least, least_quota(root / mount, name));
      }
    }
  }
  if (!std::isfinite(least)) return no_quota;
  return std::max(1, static_cast<int>(std::floor(std::min(least, 1e6))));
}

void limit_threads() {
  std::ifstream file("/proc/self/cgroup");
  const std::string groups(std::istreambuf_iterator<char>(file), {});
  omp_set_num_threads(std::min(default_threads(), cores_by_quota(groups, "/sys/fs/cgroup")));
}

}  // namespace bounce
