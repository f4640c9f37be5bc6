#include "driver/world/limits.hpp"

#include <omp.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "kernels/stepping/threads.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

constexpr double endless = std::numeric_limits<double>::infinity();

// The first number of a file; nothing if it is not there or begins with a word ("max").
std::optional<double> number_in(const fs::path& path) {
  std::ifstream file(path);
  double number = 0.0;
  return file >> number ? std::optional(number) : std::nullopt;
}

// The number behind a name, in a file that says one or more of these a line.
std::optional<double> number_of(const fs::path& path, std::string_view name) {
  std::ifstream file(path);
  double number = 0.0;
  for (std::string word; file >> word;) {
    if (word == name && file >> number) return number;
  }
  return std::nullopt;
}

// The first of these that there is.
double number_of(const fs::path& path, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    if (const auto number = number_of(path, name)) return *number;
  }
  return 0.0;
}

// A group of a tree and all above it, the topmost first.
void add_line(const fs::path& tree, const std::string& name, std::vector<fs::path>& folders) {
  folders.push_back(tree);
  for (const fs::path& part : fs::path(name).relative_path()) {
    if (part == "..") return;  // above what this process sees
    folders.push_back(folders.back() / part);
  }
}

// The folders, whether they exist or not, of all groups that may limit what `controller` deals out.
std::vector<fs::path> folders_of(const ControlGroups& groups, const std::string& controller) {
  std::vector<fs::path> folders;
  std::istringstream lines(groups.names);
  for (std::string line; std::getline(lines, line);) {  // number:controllers:name
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string name = line.substr(second + 1);
    if (controllers.empty()) {
      add_line(groups.root, name, folders);
      add_line(groups.root / "unified", name, folders);
    } else if (("," + controllers + ",").find("," + controller + ",") != std::string::npos) {
      add_line(groups.root / controllers, name, folders);
      if (controllers != controller) add_line(groups.root / controller, name, folders);
    }
  }
  return folders;
}

// Of one group: processor time over time.
double quota_of(const fs::path& group) {
  double quota = 0.0, period = 0.0;
  std::ifstream both(group / "cpu.max");
  if (!(both >> quota >> period)) {
    quota = number_in(group / "cpu.cfs_quota_us").value_or(-1.0);
    period = number_in(group / "cpu.cfs_period_us").value_or(0.0);
  }
  return quota > 0.0 && period > 0.0 ? quota / period : endless;
}

// Of one group: bytes.
double memory_left_in(const fs::path& group) {
  double limit = endless;
  for (const char* name : {"memory.max", "memory.high", "memory.limit_in_bytes"}) {
    limit = std::min(limit, number_in(group / name).value_or(endless));
  }
  const fs::path parts = group / "memory.stat";
  // (Version 1 tells here of limits of groups that are out of sight, too.)
  limit = std::min(limit, number_of(parts, "hierarchical_memory_limit").value_or(endless));
  if (limit == endless) return endless;
  const auto used = number_in(group / "memory.current");
  const double taken = used ? *used : number_in(group / "memory.usage_in_bytes").value_or(0.0);
  const double files = number_of(parts, {"total_active_file", "active_file"}) +
                       number_of(parts, {"total_inactive_file", "inactive_file"});
  return std::max(0.0, limit - std::max(0.0, taken - files));
}

}  // namespace

ControlGroups own_groups() {
  std::ifstream file("/proc/self/cgroup");
  return {std::string(std::istreambuf_iterator<char>(file), {}), "/sys/fs/cgroup"};
}

int cores_by_quota(const ControlGroups& groups) {
  double least = endless;
  for (const fs::path& group : folders_of(groups, "cpu")) least = std::min(least, quota_of(group));
  if (!std::isfinite(least)) return no_quota;
  return std::max(1, static_cast<int>(std::floor(std::min(least, 1e6))));
}

double memory_by_limits(const ControlGroups& groups) {
  double least = endless;
  for (const fs::path& group : folders_of(groups, "memory")) {
    least = std::min(least, memory_left_in(group));
  }
  return least;
}

double available_memory() {
  double bytes = 1024.0 * number_of("/proc/meminfo", "MemAvailable:").value_or(endless);
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const double taken = 1024.0 * number_of("/proc/self/status", "VmSize:").value_or(0.0);
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur) - taken);
  }
  return std::max(0.0, std::min(bytes, memory_by_limits(own_groups())));
}

void limit_threads() {
  limit_cores(cores_by_quota(own_groups()));
  omp_set_num_threads(default_threads());  // for what does not ask, such as Eigen
}

}  // namespace bounce
