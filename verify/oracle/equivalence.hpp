// Are the kernels right? Each is run beside the oracle, the paper's program in C++, on a whole
// scene and compared.
//
// What is demanded, and why
//  - `strict` does the listing's operations in the listing's order: the same bits, at every step.
//  - The fast kernels round otherwise. At the first step at which a bit differs, velocities may be
//    off by the rounding of a kick and positions by one ULP of the largest coordinate.
//  - From there on a kernel that only rounds otherwise does to the ball what a disturbance of one
//    ULP does. So six copies of the ball, disturbed by one ULP at the start, are run along (with
//    `strict`, whose bits are the oracle's), and a kernel may be off by ten times what any copy was
//    off at most so far. Ten, because copies are samples of how far rounding carries, which after
//    the impact grows exponentially. Six, because a grazing contact goes one way or the other, and
//    two copies may both go the oracle's way: in Example 6 the lowest height of the centre has
//    three values, 1.5e-8 and 1.1e-7 cm apart, and 4, 5 and 2 of 11 runs, the oracle's among the 4,
//    came to each. (These are bits, the same on every processor.)
//  - The same for what a person would measure on the whole run: heights, energies, contact.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// A kernel to be checked, and how to make it from a problem.
struct KernelUnderTest {
  std::string name;
  bool same_bits = false;  ///< it claims the oracle's bits
  std::function<std::unique_ptr<Stepper>(const Problem&)> make;
  /// Whether it is for this problem at all; where it is not it has no rows. Empty: for all.
  std::function<bool(const Problem&)> runs{};
};

/// Every registered kernel, on one thread, with the given vector target ("auto", ...), for the
/// problems that it can step. Throws PlanError for a target that is not available.
std::vector<KernelUnderTest> kernels_under_test(const std::string& vector = "auto");

/// One line of the table. Numbers are printed as they were compared.
struct EquivalenceRow {
  std::string scene;
  std::string kernel;
  std::string check;
  std::string measured;
  std::string allowed;
  bool pass = false;

  template <class Words>
  void serialize(Words& words) {
    words(scene, kernel, check, measured, allowed, pass);
  }
};

/// Called now and then with the steps done so far.
using EquivalenceProgress = std::function<void(std::int64_t done)>;

/// Runs the scene for `steps` steps on the oracle and on the kernels. `observables` adds the rows
/// on heights, energies and contact. Throws std::invalid_argument if the oracle cannot run the
/// scene.
std::vector<EquivalenceRow> check_equivalence(const std::string& name, const Scene& scene,
                                              std::int64_t steps, bool observables,
                                              std::span<const KernelUnderTest> kernels,
                                              const EquivalenceProgress& progress = {});

/// The scene with its ball just above the wall it will meet, at the speed it will have there:
/// contact within some ten thousand steps, so that short checks reach the walls too.
Scene at_the_wall(const Scene& scene);

/// |a - b| in units of the last place of the larger one; infinite if either is not finite.
double ulps_between(double a, double b);

}  // namespace bounce
