// A ball in its own frame: what of its energy vibrates, and starts from which to look at it.
#pragma once

#include "kernels/model/problem.hpp"

namespace bounce {

/// What the bonds hold above their energy at rest, erg: sum of V(R) - V(R0), none of which is
/// negative but for rounding.
double elastic_energy(const Problem& problem, const State& state);

/// Kinetic energy about the centre of mass, erg (unit masses).
double inner_motion(const State& state);

/// Velocity of the centre of mass, cm/s.
Vec2 mean_velocity(const State& state);

/// Length of the shortest bond at rest, cm.
double shortest_rest(const Problem& problem);

/// Moves each coordinate by a random length of at most `size` (cm), always the same ones.
void disturb(State& state, double size);

/// Adds the same velocity to every particle, cm/s.
void push(State& state, Vec2 velocity);

}  // namespace bounce
