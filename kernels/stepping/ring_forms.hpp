// What the ring kernels are compiled for, and what they say of it.
#pragma once

#include <string>

#include "kernels/stepping/plan.hpp"
#include "kernels/stepping/ring_shape.hpp"

namespace bounce {

/// Why the ring kernels cannot run this problem, or nothing and its shape: the neighbour list must
/// be rings, law and number of rings among the compiled forms.
struct RingForm {
  RingShape shape;
  std::string refusal;
};
RingForm find_ring_form(const Problem& problem);

/// Multiplications and multiply-adds of whole vectors that `columns` columns take: what the ports
/// must do at least.
double ring_multiplications(const Problem& problem, int rings, std::int64_t columns);

}  // namespace bounce
