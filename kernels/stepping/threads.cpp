#include "kernels/stepping/threads.hpp"

#include <omp.h>

#include <algorithm>

namespace bounce {

int default_threads() { return std::min(omp_get_max_threads(), omp_get_num_procs()); }

}  // namespace bounce
