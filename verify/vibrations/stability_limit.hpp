// How large a step a method bears, from its stage table alone.
//
// A vibration of angular frequency w is the oscillator x'' = -w^2 x. In x and v/w a stage (b, c) of
// a method does to it, with z = w dt,
//
//   kick   v/w -= b z x,        drift   x += c z v/w,
//
// and a step is the product M(z) of these matrices. Its determinant is 1, so the two eigenvalues of
// M multiply to 1: while |trace M|/2 < 1 they lie on the unit circle and nothing grows, beyond it
// one of them is larger than 1. Every other part of the motion of a ball, at one state, is a sum of
// such vibrations.
//
// Beyond the limit a method may be stable again. Where cos z, which trace M/2 follows, touches -1
// or 1, it passes it by as little as the method's error: blanes-moan-4 and blanes-moan-6 first
// leave at z = 3.16 and 3.14, for 0.2 % and 0.03 % of z, in which a vibration grows by e in 400 and
// 2000 steps, and for good at 5.03 and 9.07. The limit is the first place all the same: a ball has
// vibrations of every frequency up to its fastest, and a run has millions of steps.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernels/model/method.hpp"

namespace bounce {

/// |trace M(z)|/2 of a step of these stages.
double half_trace(std::span<const Stage> stages, double z);

/// The largest z for which a step is stable at every smaller z > 0: where |trace M|/2 first passes
/// 1. A point where it touches 1 and turns back is no edge. 0 for a table that is unstable from the
/// start or has a number that is not finite; infinity for one that is stable beyond twice the
/// number of its stages, which no consistent method is: trace M/2 = 1 - z^2/2 + ... is a polynomial
/// of degree s, at most the number of stages, in z^2, and such a one with this slope at 0 cannot
/// stay within -1 and 1 beyond z = 2 s (Markov's inequality; Chebyshev's T_s(1 - z^2/(2 s^2))
/// does).
double stability_limit(std::span<const Stage> stages);
double stability_limit(const Method& method);

/// What the energy of a vibration grows by in one of its periods, as a logarithm: 0 where a step is
/// stable, infinite where the trace is not finite.
double growth_per_period(std::span<const Stage> stages, double z);

/// Steps between two stable ones.
struct UnstableWindow {
  double from, to;  ///< z; a window that is open at the end of the search ends there
  double worst;     ///< the z of the greatest growth (in wide ones, on the grid of the search)
  double growth;    ///< growth_per_period there
};

/// All unstable windows up to twice the number of stages, lowest first. Stable steps between two
/// windows are seen if they are wider than 0.001.
std::vector<UnstableWindow> unstable_windows(std::span<const Stage> stages);

/// Where in the window growth_per_period first exceeds `growth`; nothing if nowhere. (It is taken
/// to rise up to the worst place.)
std::optional<double> first_growing(std::span<const Stage> stages, const UnstableWindow& window,
                                    double growth);

/// The largest stable step (s) for vibrations up to `omega` (1/s); infinity for omega = 0.
double stable_step(const Method& method, double omega);

}  // namespace bounce
