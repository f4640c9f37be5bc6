// Contact "located": the paper's rule in the limit of small steps, with the time of each contact
// found, so that the method keeps its order through it. A kernel that wraps another.
//
// A particle that reaches a wall (n.x = offset) has its tangential velocity multiplied by alpha and
// its normal one by beta, at that time. With beta = 0 it then stays there while its normal
// acceleration is not above 0, and is free when that rises above 0; meanwhile it sticks (alpha < 1)
// or slides (alpha = 1). A bounce lower than the roundings of a coordinate counts as rest.
//
// Why it is built so
//  1. Contacts are few: 144 in Example 5, 375 in Example 6 (results/contact.md), in 18 million of
//     the paper's steps. What a step with one costs does not matter, but it has to be made with all
//     particles, from the step's start to the contact and from there on. A particle's own path put
//     right afterwards, as by the resolved rule, leaves an error of first order, and a ball
//     multiplies it up to the end: by 40 000 in these examples (column "times" there).
//  2. So a ball that is clear of the walls runs on the kernel inside, and one that is near runs
//     step by step in contact_solver.hpp, in plain loops.
//  3. Which of the two follows from the state alone: for how many steps it is far enough away is
//     decided when the last decision has run out, and a snapshot carries what is left of it. So a
//     run has the same bits for any threads, vectors and restarts.
//  4. A kernel that cannot hold every state, as that of half balls cannot, says so
//     (Stepper::conform): states are kept in its form near a wall, too.
//  5. How far a particle gets is estimated: four times the ball's greatest speed, and twice the way
//     of its greatest acceleration, whatever their directions. A vibration has one or the other.
//     The kernel inside has the resolved rule, so what should come to a wall all the same is met
//     there.
//
// Cost: near a wall a step takes several times as long as on the kernel inside. In Examples 1, 2
// and 4 to 6 the ball is in contact for less than a third of the time (results/contact.md).
//
// A step that is cut is two of other lengths, which a symplectic method does not keep its energy
// through: with steps of 0.87 of the stable one leapfrog blows up in Examples 4 to 6, where uncut
// ones do not (leapfrog at 3.33e-4 s in results/accuracy/). Contacts are too few to matter at
// smaller steps.
//
// Not taken: the kernels' passes with the resting particles put back after each (their tiles and
// teams have no place to do it); the reflections of resolved contact for all but the steps with
// contacts (stages that step back lift what rests off the wall, so methods above order 2 lose it).
#pragma once

#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// Registry entry of `located`: it wraps the kernel that a plan picks for the same problem with
/// resolved contact, and is for walls that all have contact "located" (validate() lets all have it
/// or none).
KernelEntry located_entry();

}  // namespace bounce
