// What this process may take: cores, memory.
//
// Control groups, those of a container or a service, have limits. They stand in files, a folder a group: of version 2 all in one tree, of version 1 in a
// tree a controller, of both side by side (hybrid) version 2 in a tree of its own. A limit of a group
// holds for all below it. What a container does not see of the groups above it is not known here.
#pragma once

#include <filesystem>
#include <limits>
#include <string>

namespace bounce {

/// The groups of a process and where they are.
struct ControlGroups {
  std::string names;           ///< what /proc/self/cgroup holds
  std::filesystem::path root;  ///< where the trees are mounted
};
/// Those of this process.
ControlGroups own_groups();

/// Cores that they allow: the least quota (cpu.max; cpu.cfs_quota_us of version 1), rounded down, as
/// threads that wait for each other at every step are no faster than the one that is put to sleep; 1
/// at least. A very large number if there is none.
int cores_by_quota(const ControlGroups& groups);
inline constexpr int no_quota = std::numeric_limits<int>::max();

/// Bytes of memory that they leave: the least, over all groups, of memory.max and memory.high
/// (memory.limit_in_bytes of version 1), less what the group has taken, but for files that are held
/// in memory and can be dropped; 0 at least. Infinite, or more than any machine has, if there is no
/// limit.
double memory_by_limits(const ControlGroups& groups);

/// Bytes that this process may still take: what the system calls available, less where a limit is
/// set for the process (ulimit -v) or its control groups.
double available_memory();

/// Tells the kernels how many cores the control groups of this process allow (limit_cores()), and
/// OpenMP how many threads to take where nobody asks for a number (default_threads()).
void limit_threads();

}  // namespace bounce
