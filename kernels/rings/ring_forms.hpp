// For which laws and numbers of rings the ring kernels are compiled, how they deal out the work,
// and what they write about it into a plan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "kernels/rings/ring_shape.hpp"
#include "kernels/stepping/kernel.hpp"
#include "kernels/stepping/law_form.hpp"

namespace bounce {

/// The shape of a problem's rings, or why the kernels ring and mirror cannot run it: its neighbour
/// list must be rings, its law and their number among the compiled forms.
struct RingForm {
  RingShape shape;
  std::string refusal;  ///< empty: they can
};
RingForm find_ring_form(const Problem& problem);

/// Whether the ring kernels are compiled for this law.
bool has_ring_law(LawForm form);

/// Deals columns to lanes, as many as the target of the request has, or four where those do not
/// come out even and nobody forced the target: fills lanes and vector of the plan. Returns why
/// that cannot be, or "". `fewest`: columns a lane must have. `even`: no lane may have more than
/// another.
std::string deal_columns(std::int64_t columns, std::int64_t fewest, bool even,
                         const KernelRequest& request, Plan& plan);

/// Says in a plan how rings are stepped: `why` this kernel can do it, and what it leaves out.
void describe_rings(const std::string& why, Plan& plan);

/// As many threads as pay: each has so many columns of vectors that its wait for another thread is
/// short beside them, and there are no more than two for a ball that one core's cache holds.
int team_size(std::int64_t columns);

/// Fills the threads of a plan: those of the request, or `usual` where it names none, but no more
/// than have `fewest` of the columns of vectors each; then the plan says so.
void deal_threads(std::int64_t columns, std::int64_t fewest, const KernelRequest& request,
                  int usual, Plan& plan);

/// How the columns of a ball are taken:
///   loop   by one thread; the ball stays in the second-level cache
///   team   by more threads, which wait for each other once a stage
///   tiles  several stages on a part of the ball at a time: for one that is larger than the cache,
///          or large enough for threads that wait for each other only once in several stages
enum class RingTraversal { loop, team, tiles };
RingTraversal ring_traversal(std::size_t columns, std::size_t threads, std::size_t bytes_a_column);

/// Multiplications and multiply-adds of whole vectors that a step of `columns` columns takes: what
/// the processor's ports must do at least.
double ring_multiplications(const Problem& problem, int rings, std::int64_t columns);
/// The same of the kernel annulus.
double annulus_multiplications(const Problem& problem, int rings, std::int64_t columns);

}  // namespace bounce
