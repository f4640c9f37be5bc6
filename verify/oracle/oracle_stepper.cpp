#include "verify/oracle/oracle_stepper.hpp"

#include <stdexcept>
#include <utility>

#include "verify/oracle/oracle.hpp"

namespace bounce {
namespace {

class OracleStepper final : public Stepper {
 public:
  OracleStepper(const Scene& scene, const State& start) : oracle_(scene, start) {}

  void advance(std::int64_t steps) override {
    if (steps <= 0) return;
    oracle_.step(steps);
    step_ += steps;
  }
  [[nodiscard]] State state() const override { return oracle_.state(); }
  [[nodiscard]] Snapshot save() const override { return {oracle_.state(), false, step_}; }
  void restore(const Snapshot& snapshot) override {
    if (snapshot.stage_held) {
      throw std::invalid_argument("the listing's scheme holds no stage over");
    }
    oracle_.set_state(snapshot.state);
    step_ = snapshot.step;
  }
  [[nodiscard]] std::int64_t step() const override { return step_; }

 private:
  Oracle oracle_;
  std::int64_t step_ = 0;
};

Preparation prepare_oracle(const Scene& scene, const Problem& problem,
                           const KernelRequest& request) {
  if (std::string why = Oracle::refusal(scene); !why.empty()) return Refusal{why};
  if (request.threads > 1) return Refusal{"the oracle is scalar, on one thread"};
  if (request.vector_is_forced) return Refusal{"the oracle is scalar, it uses no vectors"};
  Plan plan;
  plan.law = "p = 3, q = 5 as the listing writes it, every bond from both ends";
  plan.walls =
      scene.walls.empty() ? "none" : "the X axis as the listing has it, others in their axes";
  plan.make_stepper = [scene, &problem] {
    return std::make_unique<OracleStepper>(scene, problem.initial);
  };
  return plan;
}

}  // namespace

std::vector<KernelEntry> kernels_with_oracle(const Scene& scene) {
  const std::span<const KernelEntry> own = kernels();
  std::vector<KernelEntry> all(own.begin(), own.end());
  all.push_back({.name = "oracle",
                 .description = "the paper's listing, scalar: the reference, slow",
                 .automatic = false,
                 .has_listings_bits = true,
                 .contacts = {Contact::listing},
                 .memory = {.a_particle = 32.0, .an_entry = 0.0},
                 .prepare = [scene](const Problem& problem, const KernelRequest& request,
                                    const PrepareInside&) {
                   return prepare_oracle(scene, problem, request);
                 }});
  return all;
}

std::unique_ptr<BookingStepper> make_booking_stepper(const Scene& scene, const Problem& problem,
                                                     const Plan& plan) {
  Scene open = scene;
  open.walls.clear();
  const std::vector<KernelEntry> entries = kernels_with_oracle(scene);
  const std::vector<KernelEntry> open_entries = kernels_with_oracle(open);
  PlanRequest request{plan.kernel, std::string(name_of(plan.vector)), plan.threads};
  if (plan.vector == VectorTarget::none) request.vector = "auto";
  return std::make_unique<BookingStepper>(
      problem, [request, entries, open_entries](const Problem& wanted) {
        return make_stepper(wanted, request, wanted.walls.empty() ? open_entries : entries);
      });
}

}  // namespace bounce
