// The ball at the start (paper, section 2).
#pragma once

#include "kernels/model/neighbours.hpp"
#include "kernels/model/pair_law.hpp"
#include "kernels/model/scene.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// Particles of a valid spec. Rings: ring by ring outwards, counter-clockwise, odd rings (the
/// second, the fourth ...) turned by half a spacing; a disc: make_disc. With Rounding::listing the
/// angles are the author's truncated multiples for 120 a ring, and every number passes through
/// FORMAT (F12.4).
State make_ball(const BallSpec& spec);

/// How large a valid spec's ball is.
struct BallSize {
  std::size_t particles = 0;
  std::size_t entries = 0;     ///< of all rows of neighbours: two a bond
  std::size_t list_bytes = 0;  ///< of its BondList, where it needs one
};
BallSize ball_size(const BallSpec& spec);

/// Who is bound to whom in a valid spec's ball.
Neighbours ball_neighbours(const BallSpec& spec);

/// Squared rest lengths by bond class, cm^2: ring 1, rings 1-2, ring 2, rings 2-3, ... in the order
/// of ring_bonds; of a disc its one spacing. Rest::listing needs the paper's ball (validate sees to
/// it).
std::vector<double> rest_lengths_squared(const BallSpec& spec, Rest rest);

/// The value that remains of x after printing and reading it as F12.4.
double four_decimals(double x);
/// x, or what remains of it with Rounding::listing.
double as_printed(Rounding rounding, double x);

}  // namespace bounce
