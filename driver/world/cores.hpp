// How many cores the program may keep busy.
#pragma once

#include <filesystem>
#include <limits>
#include <string>

namespace bounce {

/// Cores that the control groups of a process allow: the least quota (cpu.max; cpu.cfs_quota_us of
/// version 1) of its groups and those above them, rounded down, as threads that wait for each
/// other at every step are no faster than the one that is put to sleep; 1 at least. A very large
/// number if there is none. `groups`: what /proc/self/cgroup holds; `root`: where the groups are
/// mounted.
int cores_by_quota(const std::string& groups, const std::filesystem::path& root);
inline constexpr int no_quota = std::numeric_limits<int>::max();

/// The threads a command takes where nobody asks for a number: OMP_NUM_THREADS, at most the
/// processors this process may run on, and what its control groups allow. OpenMP gets that number,
/// and with it kernels and analyses (default_threads()).
void limit_threads();

}  // namespace bounce
