// The ring kernel made to go through all of its ball a stage: what stepping tiles several stages
// in cache is held against.
#pragma once

#include <memory>

#include "kernels/plan/plan.hpp"

namespace bounce {

/// The stepper that the ring kernel would make, but for the stages it takes while a tile is in
/// cache: one. For three rings, law (3, 5), a floor.
std::unique_ptr<Stepper> make_plain_sweep(const Problem& problem, VectorTarget vector, int threads);

}  // namespace bounce
