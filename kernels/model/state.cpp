#include "kernels/model/state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace bounce {

bool is_finite(const State& state) {
  const auto finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  return finite(state.x) && finite(state.y) && finite(state.vx) && finite(state.vy);
}

std::uint64_t state_hash(const State& state) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a offset basis and prime, 64 bits
  for (const auto* values : {&state.x, &state.y, &state.vx, &state.vy}) {
    for (const double value : *values) {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      for (int byte = 0; byte < 8; ++byte) {
        hash = (hash ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100000001b3U;
      }
    }
  }
  return hash;
}

}  // namespace bounce
