// Which code runs a problem, decided once, before the first step: kernel, vector target, threads,
// and the instantiation that leaves out what the scene does not need.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// Vector instruction sets a kernel can be told to use.
enum class VectorTarget { none, avx2, avx512 };
std::string_view name_of(VectorTarget target);

/// What the user forces; "auto" and 0 leave it to the plan.
struct PlanRequest {
  std::string kernel = "auto";
  std::string vector = "auto";  ///< auto, avx2, avx512
  int threads = 0;              ///< 1 to 256; 0: the plan decides
};

/// The decision, with what a reader of run.json wants to know of it.
struct Plan {
  std::string kernel;
  VectorTarget vector = VectorTarget::none;
  int lanes = 1;  ///< numbers computed side by side
  int threads = 1;
  /// Multiplications and multiply-adds of whole vectors a step takes at least; 0: not counted.
  double multiplications = 0.0;
  std::string law;                    ///< which form of the law was compiled in
  std::string walls;                  ///< which form of the walls was compiled in
  std::vector<std::string> left_out;  ///< what this scene does not need and this code does not have
  std::vector<std::string> reasons;   ///< why this kernel, and why not the faster ones
};

/// A forced choice that cannot run the problem. Never answered by running something else.
class PlanError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// What a stepper takes beside the problem, bytes, for each particle and each entry of their rows.
struct StepperMemory {
  double a_particle;
  double an_entry;
};

/// One kernel, as the registry knows it.
struct KernelEntry {
  std::string name;
  std::string description;
  bool automatic;  ///< may `auto` pick it
  StepperMemory memory;
  /// Fills lanes, threads, law, walls and left_out of the plan, or returns why it cannot run this.
  std::function<std::string(const Problem&, const PlanRequest&, Plan&)> prepare;
  std::function<std::unique_ptr<Stepper>(const Problem&, const Plan&)> make;
};

/// From here on a second thread saves more than meeting it costs, whatever the kernel and however
/// far apart the cores are.
inline constexpr std::size_t particles_worth_a_team = 20000;

/// The kernels of this folder, fastest first. Adding one adds a line to kernel_registry.cpp.
std::span<const KernelEntry> kernels();

/// Vector targets that this processor and this build can run, best first.
std::vector<VectorTarget> available_vectors();

/// The target of that name, or the best one for "auto". Throws PlanError if this machine has not
/// got it.
VectorTarget choose_vector(const std::string& wanted);

/// Throws PlanError unless 0 <= threads <= 256.
void check_threads(int threads);

/// Picks the first automatic entry that can run the problem, or the one forced. Throws PlanError.
Plan make_plan(const Problem& problem, const PlanRequest& request = {},
               std::span<const KernelEntry> entries = kernels());

/// The kernel the plan names, holding the problem's initial state. The problem is copied as needed.
std::unique_ptr<Stepper> make_stepper(const Problem& problem, const Plan& plan,
                                      std::span<const KernelEntry> entries = kernels());

}  // namespace bounce
