#include "bench/memory_rate.hpp"

#include <benchmark/benchmark.h>

#include <chrono>

namespace bounce {

MemoryRate::MemoryRate(std::size_t bytes) : values_(bytes / sizeof(double), 1.0) {}

double MemoryRate::measure(int threads) {
  const std::size_t count = values_.size();
  double* values = values_.data();
  double factor = 1.0;
  benchmark::DoNotOptimize(factor);
  const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for simd num_threads(threads) schedule(static)
  for (std::size_t i = 0; i < count; ++i) values[i] *= factor;
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  benchmark::ClobberMemory();
  return 2.0 * sizeof(double) * static_cast<double>(count) / time.count();
}

}  // namespace bounce
