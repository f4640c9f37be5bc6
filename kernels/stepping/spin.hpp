// Waiting for another thread for a fraction of a microsecond.
#pragma once

#include <hwy/cache_control.h>

#include <atomic>
#include <cstdint>
#include <thread>

namespace bounce {

/// Returns once counter >= value. Spins first; then gives the processor away at each look, so that
/// more threads than cores make a run slow but never stop it.
inline void wait_for(const std::atomic<std::int64_t>& counter, std::int64_t value) {
  constexpr int spins = 2000;  // some 20 microseconds: many steps' worth, less than a time slice
  for (int i = 0; counter.load(std::memory_order_acquire) < value; ++i) {
    if (i < spins) {
      hwy::Pause();
    } else {
      std::this_thread::yield();
    }
  }
}

/// Where all threads of a team meet once a stage. The last to arrive opens the next round.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): a cache line for each counter
class SpinBarrier {
 public:
  explicit SpinBarrier(int threads) : threads_(threads) {}
  /// `round` counts this thread's meetings, from 1.
  void meet(std::int64_t round) {
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == round * threads_) {
      open_.store(round, std::memory_order_release);
    } else {
      wait_for(open_, round);
    }
  }

 private:
  int threads_;
  alignas(64) std::atomic<std::int64_t> arrived_{0};
  alignas(64) std::atomic<std::int64_t> open_{0};
};

}  // namespace bounce
