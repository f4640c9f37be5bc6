// What the ring kernels are compiled for, and what they say of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "kernels/rings/ring_shape.hpp"
#include "kernels/stepping/kernel.hpp"
#include "kernels/stepping/law_form.hpp"

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

/// Deals columns to lanes, as many as the target of the request has, or four where those do not come
/// out even and nobody forced the target: fills lanes and vector of the plan. Why it cannot, or "".
/// `fewest`: columns a lane must have. `even`: no lane may have more than another.
std::string deal_columns(std::int64_t columns, std::int64_t fewest, bool even,
                         const KernelRequest& request, Plan& plan);

/// Says in a plan how rings are stepped: `why` this kernel can do it, and what it leaves out.
void describe_rings(const std::string& why, Plan& plan);

/// As many threads as pay: each has at least so many columns of vectors that a hand-shake is short
/// beside them, and there are no more than two for a ball that one core's cache holds.
int team_size(std::int64_t columns);

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
/// The same of the kernel annulus.
double annulus_multiplications(const Problem& problem, int rings, std::int64_t columns);

}  // namespace bounce
