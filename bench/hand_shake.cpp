#include "bench/hand_shake.hpp"

#include <omp.h>

#include <atomic>
#include <chrono>
#include <cstdint>

#include "kernels/stepping/threads.hpp"

namespace bounce {

double hand_shake_time() {
  constexpr std::int64_t rounds = 1000;
  struct alignas(64) Word {
    std::atomic<std::int64_t> value{0};
  };
  Word there, back;
  double seconds = 0.0;
#pragma omp parallel num_threads(2)
  {
    const bool alone = omp_get_num_threads() == 1;
    const auto start = std::chrono::steady_clock::now();
    for (std::int64_t i = 1; i <= rounds && !alone; ++i) {
      if (omp_get_thread_num() == 0) {
        there.value.store(i, std::memory_order_release);
        wait_for(back.value, i);
      } else {
        wait_for(there.value, i);
        back.value.store(i, std::memory_order_release);
      }
    }
    if (omp_get_thread_num() == 0) {
      seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
  }
  return seconds / rounds;
}

}  // namespace bounce
