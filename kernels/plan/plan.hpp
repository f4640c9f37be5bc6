// Which kernel steps a problem, decided once, before the first step.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// What the user forces; "auto" and 0 leave it to the plan.
struct PlanRequest {
  std::string kernel = "auto";
  std::string vector = "auto";  ///< auto, avx2, avx512
  int threads = 0;              ///< at most, 1 to 256; 0: as many as pay
  /// Threads beyond the cores this process may use (usable_cores()) are not started, as they would
  /// wait for each other's turn at every stage, unless this is true: then the bits can be compared
  /// on any machine.
  bool more_threads_than_cores = false;
};

/// A forced choice that cannot run the problem. Never answered by running something else.
class PlanError : public std::invalid_argument {
 public:
  /// `field`: the part of the request that cannot be, or "" if it is the problem.
  PlanError(std::string which, const std::string& what)
      : std::invalid_argument(what), field(std::move(which)) {}
  std::string field;  ///< "kernel", "vector", "threads" or ""; the message begins with it
};

/// All kernels, fastest first. Adding one adds a line to kernel_registry.cpp.
std::span<const KernelEntry> kernels();

/// The vector target of that name, or the best one for "auto". Throws PlanError if this machine has
/// not got it.
VectorTarget choose_vector(const std::string& wanted);

/// Throws PlanError unless 0 <= threads <= 256.
void check_threads(int threads);

/// Picks the first automatic entry that can step the problem, or the one forced; where that one is
/// for other contacts, one that wraps it. Throws PlanError. The problem has to live until the plan
/// has made its last stepper; one that is moved in is kept by the plan.
Plan make_plan(const Problem& problem, const PlanRequest& request = {},
               std::span<const KernelEntry> entries = kernels());
Plan make_plan(Problem&& problem, const PlanRequest& request = {},
               std::span<const KernelEntry> entries = kernels());

/// The stepper of the plan for a request.
std::unique_ptr<Stepper> make_stepper(const Problem& problem, const PlanRequest& request = {},
                                      std::span<const KernelEntry> entries = kernels());

/// The plan's kernel, for people: with the one it wraps.
std::string kernel_name(const Plan& plan);

}  // namespace bounce
