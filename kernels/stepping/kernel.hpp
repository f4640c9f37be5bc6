// What a kernel owes. Asked about a problem, it says why it cannot step it, or how it will: a plan,
// which also makes the stepper and holds whatever was found out on the way (shape, axis ...), so
// that nothing is searched for twice and no plan meets another problem. kernels/plan/ picks one.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"
#include "kernels/stepping/vector_target.hpp"

namespace bounce {

/// What is asked of a kernel.
struct KernelRequest {
  std::string kernel;  ///< "auto" or a name; for a kernel that wraps another: which one
  VectorTarget vector = VectorTarget::none;  ///< to be used
  bool vector_is_forced = false;             ///< then no other one will do
  int threads = 0;                           ///< at most; 0: as many as pay
};

/// The decision, with what a reader of run.json wants to know of it.
struct Plan {
  std::string kernel;
  std::string inside;  ///< of a kernel that wraps another: that one's name
  VectorTarget vector = VectorTarget::none;
  int lanes = 1;  ///< numbers computed side by side
  int threads = 1;
  /// Multiplications and multiply-adds of whole vectors a step takes at least; 0: not counted.
  double multiplications = 0.0;
  bool cuts_steps = false;            ///< a step may be taken in parts, where a contact begins
  std::string law;                    ///< which form of the law was compiled in
  std::string walls;                  ///< how many, and how they are met
  std::vector<std::string> left_out;  ///< what this scene does not need and this code does not have
  std::vector<std::string> reasons;   ///< why this kernel, and why not the faster ones
  /// Makes the kernel at work, at the start of the problem that was planned for, which must still
  /// exist.
  std::function<std::unique_ptr<Stepper>()> make_stepper;
};

/// Why a kernel cannot run a problem: one clause, to stand behind a colon.
struct Refusal {
  std::string why;
};
using Preparation = std::variant<Plan, Refusal>;

/// Prepares another kernel, for one that wraps it.
using PrepareInside = std::function<Preparation(const Problem&, const KernelRequest&)>;

/// Bytes that a stepper takes beside the problem, for each particle and for each entry of the
/// neighbour list.
struct StepperMemory {
  double a_particle;
  double an_entry;
};

/// One kernel, as the registry knows it.
struct KernelEntry {
  std::string name;
  std::string description;
  bool automatic = true;           ///< may `auto` pick it
  bool has_listings_bits = false;  ///< it claims the oracle's bits
  bool wraps = false;              ///< it holds another kernel; its memory comes on top
  std::vector<Contact> contacts = {Contact::listing, Contact::resolved};  ///< that it can do
  StepperMemory memory;
  std::function<Preparation(const Problem&, const KernelRequest&, const PrepareInside&)> prepare;

  /// Whether it can do the contacts of all these walls; one that wraps another is for walls alone.
  [[nodiscard]] bool has_contacts_of(const std::vector<Wall>& walls) const;
};

}  // namespace bounce
