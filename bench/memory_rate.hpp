// How fast memory can be read and written in place: what a sweep over a large ball cannot beat.
#pragma once

#include <cstddef>
#include <vector>

namespace bounce {

/// Numbers that no cache holds, multiplied in place: as a sweep treats a ball's state.
class MemoryRate {
 public:
  /// `bytes` of them.
  explicit MemoryRate(std::size_t bytes);
  /// Bytes a second, read and written counted each, by so many threads; measured now, once over.
  double measure(int threads);

 private:
  std::vector<double> values_;
};

}  // namespace bounce
