// Finds out whether a problem is left-right symmetric, so that half the ball is enough: the paper
// gives 4.5 h with symmetry where the whole ball of Example 1 took 6.9 h.
#pragma once

#include <cstdint>
#include <string>

#include "kernels/model/problem.hpp"
#include "kernels/rings/ring_shape.hpp"

namespace bounce {

/// The mirror image about x = 0 of a ball of rings: column k of a ring without stagger is the image
/// of column `sum` - k, of a staggered ring of column `sum` - 1 - k (modulo the columns). `sum` is
/// even: the axis goes through columns sum / 2 and sum / 2 + half of the rings without stagger.
struct MirrorAxis {
  std::int64_t sum = 0;
  std::string refusal;  ///< why there is none; empty if there is one
};

/// The axis of the problem's forces, walls and start. Exact: one bit of difference refuses.
MirrorAxis find_mirror_axis(const Problem& problem, const RingShape& shape);

/// Why `state` is not its own mirror image about that axis, or nothing.
std::string not_symmetric(const State& state, const RingShape& shape, std::int64_t sum);

/// Makes a state that is symmetric but for roundings so to the bit: of two images the one with the
/// lower number decides.
void make_symmetric(const RingShape& shape, std::int64_t sum, State& state);

/// The image of column `column` of ring `ring`.
inline std::int64_t mirror_image(const RingShape& shape, std::int64_t sum, int ring,
                                 std::int64_t column) {
  const std::int64_t image = sum - ring % 2 - column;
  return ((image % shape.per_ring) + shape.per_ring) % shape.per_ring;
}

}  // namespace bounce
