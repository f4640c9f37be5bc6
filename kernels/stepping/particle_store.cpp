#include "kernels/stepping/particle_store.hpp"

#include <algorithm>

namespace bounce {
namespace {

constexpr std::size_t pad = 8;  // doubles of the widest vector

void fill(AlignedArray& array, const std::vector<double>& values) {
  std::copy(values.begin(), values.end(), array.data());
  for (std::size_t i = values.size(); i < array.size(); ++i) array[i] = values.back();
}

void copy_out(const AlignedArray& array, std::vector<double>& values) {
  std::copy_n(array.data(), values.size(), values.begin());
}

AlignedArray padded(std::size_t particles) {
  return AlignedArray((particles + pad - 1) / pad * pad);
}

}  // namespace

AlignedArray::AlignedArray(std::size_t size)
    : values_(hwy::AllocateAligned<double>(size)), size_(size) {
  std::fill_n(values_.get(), size, 0.0);
}

ParticleStore::ParticleStore(std::size_t particles)
    : x{padded(particles), padded(particles)},
      y{padded(particles), padded(particles)},
      vx(padded(particles)),
      vy(padded(particles)) {}

void ParticleStore::write(const State& state) {
  fill(x[current], state.x);
  fill(y[current], state.y);
  fill(vx, state.vx);
  fill(vy, state.vy);
}

void ParticleStore::read(State& state) const {
  copy_out(x[current], state.x);
  copy_out(y[current], state.y);
  copy_out(vx, state.vx);
  copy_out(vy, state.vy);
}

}  // namespace bounce
