// How fast a ball can vibrate at a state: the Hessian of its bond energy, the largest eigenvalue of
// that, and a bound of it that costs no more than a look at the energies.
//
// Masses are 1, so an eigenvalue lambda is the square of an angular frequency, and a method whose
// limit is z is stable at this state for steps below z / sqrt(lambda_max) (stability_limit.hpp).
// Only the largest eigenvalue matters: a negative one belongs to a motion that grows by itself,
// whatever the step. Gravity and walls add nothing: gravity is constant, and a wall only mirrors.
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <optional>

#include "kernels/model/problem.hpp"

namespace bounce {

/// Rows and columns x1, y1, x2, y2, ...; g/s^2, which for unit masses is 1/s^2.
using Hessian = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Second derivatives of the bond energy at the state's positions: 2N x 2N, symmetric to the bit.
/// Where a stiffness is not finite (a NaN, two particles in one place) so are entries.
Hessian bond_hessian(const Problem& problem, const State& state);

/// The largest eigenvalue of a symmetric matrix by Lanczos (Spectra) from a fixed start vector, so
/// that the same matrix gives the same answer; of at most 100 rows by Eigen's dense solver. Stops
/// when the residual is below `tolerance` times the answer: an eigenvalue lies as near as that, in
/// practice much nearer (the error goes with the square of the residual where eigenvalues stand
/// apart). The answer is never above the largest eigenvalue but for rounding. Nothing if an entry
/// is not finite, or if it does not converge.
std::optional<double> largest_eigenvalue(const Hessian& hessian, double tolerance);

/// A bound of the largest eigenvalue, and the bond it owes most to.
struct StiffnessBound {
  double lambda = 0.0;  ///< no eigenvalue is larger, 1/s^2; 0 if no bond resists anything
  /// Of the bond with the largest stiffness: its particles, from 0, and its R/R0.
  std::int64_t first = 0, second = 0;
  double ratio = 0.0;
};

/// Costs about as much as measure(). Nothing if a stiffness or the bound is not finite.
std::optional<StiffnessBound> stiffness_bound(const Problem& problem, const State& state);

/// The fastest vibration at a state.
struct FastestVibration {
  double omega = 0.0;  ///< its angular frequency, 1/s: Lanczos's, or the bound's if not exact
  bool exact = false;  ///< found by Lanczos
  StiffnessBound bound;
};

/// How fastest_vibration() sets Lanczos to work. The eigenvalues of a ring of n at rest crowd
/// together as 1/n^2 below the largest, so that a fixed tolerance takes ever more products.
inline constexpr std::size_t small_ball = 2'000;  ///< particles up to which fine_tolerance is quick
inline constexpr double fine_tolerance = 1e-7;    ///< good to 10 digits on the paper's ball
inline constexpr double coarse_tolerance = 1e-3;  ///< larger balls; good to 4 digits of omega
/// Beyond this many particles, where Lanczos would take about a second, the bound is used. On rings
/// of that many at rest it lies less than 0.01 % above the frequency; where stiffness varies from
/// bond to bond, some per cent.
inline constexpr std::size_t lanczos_particles = 50'000;

/// Nothing if a stiffness is not finite.
std::optional<FastestVibration> fastest_vibration(const Problem& problem, const State& state);

}  // namespace bounce
