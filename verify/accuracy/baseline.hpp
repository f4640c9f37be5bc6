// Solvers that are no table of stages, as baselines of the methods: an implicit conservative one,
// and GSL's adaptive ones, with contacts located as in a reference: Runge-Kutta-Fehlberg of orders
// 4 and 5, Prince-Dormand of 8 and 9, Adams's multistep method of orders 1 to 12, and two for
// stiff motions, backward differences of orders 1 to 5 and Bader and Deuflhard's extrapolation of
// the implicit midpoint rule (at most 1000 particles). One interface; another one is a line in
// baseline.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/accuracy/accuracy.hpp"
#include "verify/accuracy/reference_solution.hpp"

namespace bounce {

/// What a solution took.
struct BaselineWork {
  std::int64_t steps = 0;
  std::int64_t evaluations = 0;  ///< of the force
};

struct Baseline {
  std::string_view name, source;
  BaselineContact contact = BaselineContact::located;
  /// Solves to the last of `times`, as solve_adaptive does, by a step or a tolerance; `tick` is
  /// called at least every output time and may throw. `figures`, if any, is filled. Throws
  /// ReferenceError for what it cannot solve.
  std::function<BaselineWork(const Problem& problem, double parameter,
                             std::span<const double> times, const ReferenceVisitor& visit,
                             const std::function<void()>& tick, Bounce* figures)>
      solve;
  /// Its parameter is a tolerance, and its steps are as long as that allows.
  [[nodiscard]] bool adaptive() const { return contact == BaselineContact::located; }
};

std::span<const Baseline> baselines();
/// Of that name, with either contact.
bool is_baseline(std::string_view name);

/// How much of a sweep is made.
struct BaselineSweep {
  int values = 4;              ///< of the parameter, the cheapest first
  double most_seconds = 60.0;  ///< of one course; what takes longer is not finished, and the rest
                               ///< of its sweep not begun
  double least_seconds = 0.5;  ///< a course is timed anew until it has had that
};

/// A row and the seconds of its course on one thread without output: the median of its repeats.
struct BaselineRow {
  AccuracyRow row;
  double seconds = 0.0;

  template <class Words>
  void serialize(Words& words) {
    words(row, seconds);
  }
};

/// Sweeps one baseline, one course after another. Steps are whole parts of the sampling interval,
/// from 4 times the edge of explicit methods at the start down by 2; tolerances 1e-4 and down by
/// 100. Of a course that was not finished the errors are infinite, and its row says why; the rest
/// is then not begun. `tick` is called often; what it throws comes out.
std::vector<BaselineRow> measure_baseline(const Baseline& baseline, const Scene& scene,
                                          const std::optional<State>& initial,
                                          const Sampling& sampling, const CourseRecord& reference,
                                          const BaselineSweep& sweep,
                                          const std::function<void()>& tick);

}  // namespace bounce
