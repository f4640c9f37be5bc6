// Arrays on cache-line boundaries: whole vectors, loaded and stored aligned.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>

#include "kernels/model/state.hpp"

namespace bounce {

/// Numbers on a 64-byte boundary, zero at the start.
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(std::size_t size);
  [[nodiscard]] double* data() { return values_.get(); }
  [[nodiscard]] const double* data() const { return values_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  double& operator[](std::size_t i) { return values_[i]; }
  const double& operator[](std::size_t i) const { return values_[i]; }

 private:
  hwy::AlignedFreeUniquePtr<double[]> values_;
  std::size_t size_ = 0;
};

/// Particles as a structure of arrays in the listing's order, each array padded to whole vectors of
/// eight; the padding repeats the last particle. Positions stand twice: a pass reads one copy and
/// writes the other, so threads need to meet only once a stage.
struct ParticleStore {
  AlignedArray x[2], y[2], vx, vy;
  int current = 0;  ///< which copy of the positions holds the present

  explicit ParticleStore(std::size_t particles);
  void write(const State& state);
  void read(State& state) const;
};

}  // namespace bounce
