// Both reference solutions of a problem side by side, and how a small disturbance grows.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "verify/accuracy/reference_solution.hpp"
#include "verify/figures/bounce.hpp"

namespace bounce {

/// A solution at the output times, and its figures (but for energies).
struct ReferencePath {
  std::vector<State> states;
  ReferenceRun run;
  Bounce bounce;

  template <class Words>
  void serialize(Words& words) {
    words(states, run, bounce);
  }
};

struct ReferencePair {
  std::vector<double> times;  ///< s
  ReferencePath adaptive, fixed;

  /// When the first particle meets a wall, in either, s; the last output time if none does.
  [[nodiscard]] double first_contact() const;
  /// Index of the last output time before that; 0 if there is none.
  [[nodiscard]] std::size_t last_before_contact() const;
};

struct ReferenceSettings {
  AdaptiveSettings adaptive;
  FixedSettings fixed;
};

/// Called from the solving threads after each output time; it may throw to stop them all.
using ReferenceTick = std::function<void()>;

/// Solves in both ways, on two threads. Throws as solve_adaptive does: what one throws first ends
/// the other at its next output time, and comes out.
ReferencePair solve_both(const Problem& problem, std::span<const double> times,
                         const ReferenceSettings& settings, const ReferenceTick& tick = {});

/// The same, and after the adaptive solution, on its thread, that of a disturbed start
/// (disturbed_start).
struct DisturbedPair {
  ReferencePair pair;
  ReferencePath disturbed;
};
/// Where solutions are kept that were found before, by the names "fixed", "adaptive", "disturbed";
/// both may be called from several threads.
struct ReferenceKeeper {
  std::function<std::optional<ReferencePath>(const std::string& name)> find;
  std::function<void(const std::string& name, const ReferencePath&)> keep;
};
DisturbedPair solve_disturbed(const Problem& problem, std::span<const double> times,
                              const ReferenceSettings& settings, double disturbance,
                              const ReferenceTick& tick = {}, const ReferenceKeeper& keeper = {});

/// Some roundings of the largest coordinate, cm: a disturbance as every step in double precision
/// makes one. What comes of it at the end is what such a course can know at best.
double rounding_disturbance(const Problem& problem);

/// How the distance between two paths went.
struct Growth {
  double start = 0.0;     ///< largest distance of a particle at time 0, cm
  double contact = 0.0;   ///< at the last output time before the first contact
  double greatest = 0.0;  ///< of all output times
  double end = 0.0;
  /// Logarithmic growth from the contact to the end over the time between, 1/s. Where the distance
  /// reaches the size of the ball it is too small: there is nothing left to grow into. NaN without
  /// contact or distance.
  double rate = 0.0;

  [[nodiscard]] double factor() const { return end / start; }
};
Growth growth_of(const DisturbedPair& paths);

}  // namespace bounce
