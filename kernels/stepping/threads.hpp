// Threads: how many, and what they need of each other.
#pragma once

#include <hwy/cache_control.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>

namespace bounce {

/// Cores that this process may keep busy: the processors that it may run on, and no more than
/// limit_cores() was last told; 1 at least. More threads than that never make a kernel faster, and
/// as they wait for each other at every stage, they can make it a thousand times slower.
int usable_cores();
void limit_cores(int most);

/// The number of threads where nobody asks for one: what OpenMP is set to (OMP_NUM_THREADS,
/// omp_set_num_threads), and no more than usable_cores().
int default_threads();

/// Particles from which on a kernel whose threads meet once a stage takes more than one thread by
/// itself: with fewer, meeting may cost more than a second thread saves.
inline constexpr std::size_t particles_worth_a_team = 20000;

/// Calls work(i) for i = 0 .. count - 1 on that many threads (0: default_threads()), each i as soon
/// as a thread is free. If a call throws, no further one is begun, and what it threw reaches the
/// caller.
template <class Work>
void parallel_for(std::size_t count, int threads, const Work& work) {
  std::exception_ptr failure;
  std::atomic<bool> failed{false};
#pragma omp parallel for schedule(dynamic, 1) \
    num_threads(threads == 0 ? default_threads() : threads)
  for (std::size_t i = 0; i < count; ++i) {
    if (failed.load()) continue;
    try {
      work(i);
    } catch (...) {
      // (The first one alone stores it, so no lock is needed; the loop's end makes it visible.)
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

/// Returns once counter >= value: for another thread, for a fraction of a microsecond. Spins first;
/// then gives the processor away at each look, so that more threads than cores make a run slow but
/// never stop it.
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
