// What the benchmarks share: a batch of work timed, and the middle of several times.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace bounce {

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Seconds that subject.advance(steps) takes.
template <class Subject>
double seconds_of(Subject& subject, std::int64_t steps) {
  const auto start = std::chrono::steady_clock::now();
  subject.advance(steps);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Steps that take `seconds` at least, found by doubling.
template <class Subject>
std::int64_t batch_for(Subject& subject, double seconds) {
  std::int64_t steps = 16;
  while (seconds_of(subject, steps) < seconds) steps *= 2;
  return steps;
}

}  // namespace bounce
