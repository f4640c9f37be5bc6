// What the ring kernels are compiled for, and what they say of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "kernels/plan/plan.hpp"
#include "kernels/rings/ring_shape.hpp"
#include "kernels/stepping/scene_forms.hpp"

namespace bounce {

/// Why the ring kernels cannot run this problem, or nothing and its shape: the neighbour list must
/// be rings, law and number of rings among the compiled forms.
struct RingForm {
  RingShape shape;
  std::string refusal;
};
RingForm find_ring_form(const Problem& problem);

/// Whether the ring kernels are compiled for this law.
bool has_ring_law(LawForm form);

/// The most lanes of the target that so many columns can be dealt to evenly, two columns a lane at
/// least: 8, 4, or 0 if neither.
int ring_lanes(std::int64_t per_ring, VectorTarget target);

/// The threads asked for, or, for 0, as many as pay: a core each, at least so many columns of
/// vectors each that a hand-shake is short beside them, and no more than two for a ball that one
/// core's cache holds.
int team_size(int asked, std::int64_t columns);

/// How the columns of a ring are gone through:
///   loop   by one thread; the ball stays in the second cache
///   team   by more threads, a hand-shake a stage
///   tiles  a ball larger than the cache, or large enough that its threads may step several stages
///          alone
enum class RingWalk { loop, team, tiles };
RingWalk ring_walk(std::size_t columns, std::size_t threads, std::size_t bytes_a_column);

/// Multiplications and multiply-adds of whole vectors that `columns` columns take: what the ports
/// must do at least.
double ring_multiplications(const Problem& problem, int rings, std::int64_t columns);
/// The same of the kernel rings.
double rings_multiplications(const Problem& problem, int rings, std::int64_t columns);

}  // namespace bounce
