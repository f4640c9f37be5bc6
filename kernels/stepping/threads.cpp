#include "kernels/stepping/threads.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <limits>

namespace bounce {

namespace {

std::atomic<int> core_limit{std::numeric_limits<int>::max()};

}  // namespace

int usable_cores() { return std::max(1, std::min(omp_get_num_procs(), core_limit.load())); }

void limit_cores(int most) { core_limit = most; }

int default_threads() { return std::min(omp_get_max_threads(), usable_cores()); }

}  // namespace bounce
