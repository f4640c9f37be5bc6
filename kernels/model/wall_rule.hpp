// What a wall does to a particle that a drift has brought to it or behind it, for one particle. The
// kernels have the same on vectors (vector_walls-inl.hpp); verify judges them by this.
//
// The paper's rule mirrors: the particle stands as far in front of the wall as it stood behind it,
// its velocity multiplied by alpha and beta. With beta = 0 a particle that is pressed to the wall
// is kicked against it each step, drifts for that step, along the wall too, and is stopped again.
// So it creeps along the wall, and loses the energy of each kick; both end only as dt -> 0.
//
// The resolved rule is the paper's with the time of the crossing known:
//  1. The drift is a straight line, so with s the distance after it (not above 0) and w its normal
//     part, the particle was behind the wall for the part s/w of the drift. For that part it moves
//     with the velocity after the impact instead: x += (s/w) drift (v_after - v). Along the normal
//     that is s -> beta s.
//  2. Where beta = 0, the particle stays on the wall. Pressed to it, it begins the next drift
//     there, which counts as resting: its tangential velocity is 0, unless alpha is 1. (Any
//     alpha < 1 makes it 0 in the limit, where a resting particle meets the wall again and again
//     in no time.)
//  3. Pulled off, it does not cross the wall, and is free.
//
// A method of high order has stages that step back, with a negative drift. They meet no wall by
// either rule: where they lead is not a place that the particle comes to. (If they did, one that is
// pulled off would be stepped back onto the wall, and stopped there, each step again: it would
// never come off. The next stages lead forth.)
//
// For alpha = 1, beta = -1 both rules are the same. For beta strictly between, a particle at rest
// jumps by some dt^2 and, with alpha < 1, still creeps by some dt.
#pragma once

#include <vector>

#include "kernels/model/scene.hpp"

namespace bounce {

/// cm and cm/s.
struct Motion {
  Vec2 position, velocity;
};

/// What the wall makes of a particle at `behind`, for which not (n.x > offset). `drift`: length of
/// the drift that ends there, s, not negative.
Motion after_wall(const Wall& wall, double drift, const Motion& behind);

/// True if one of them has another contact than the listing's.
bool any_resolved(const std::vector<Wall>& walls);

/// Drifts for which a particle can have been behind a wall. More than one if a stage stepped back
/// behind it before: the way is then followed back through the start of the drift.
inline constexpr double most_part_behind = 2.0;

/// Part of its coordinates' size that a particle may begin a drift above a wall and count as
/// resting on it: the roundings of a coordinate, of a distance and of what it moved by.
inline constexpr double resting_slack = 0x1p-49;

}  // namespace bounce
