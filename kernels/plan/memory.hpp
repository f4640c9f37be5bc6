// What a scene takes in memory, said before anything is allocated.
#pragma once

#include <string>

#include "kernels/model/scene.hpp"

namespace bounce {

/// Bytes that the scene's Problem and its stepper take together, at most; a part that does not grow
/// with the ball (ghosts, tables, below 1 MB a thread) is left out. `kernel`: a name of kernels(),
/// or "auto" for the most that any of those takes.
///
/// A state is 32 bytes a particle (x, y, vx, vy). Per particle, with e entries in its row:
///   mirror, ring, annulus   32 start + 32 in the kernel's layout              2 states, no index
///   csr, strict             32 start + 48 (positions stand twice) + 4 + 2 e   index of 8 bytes an
///                           and for a list 8 + 6 e                            entry and less
///   located contact         300 beside those of the kernel it wraps
/// After the start is let go, as a run does, every kernel but located contact is within 2 states
/// and 8 bytes an entry.
/// memory_test holds this against what is allocated. Expects a valid scene.
double solver_bytes(const Scene& scene, const std::string& kernel = "auto");

}  // namespace bounce
