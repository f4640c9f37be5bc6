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

std::string prepare(const Scene& scene, const PlanRequest& request, Plan& plan) {
  if (std::string why = Oracle::refusal(scene); !why.empty()) return why;
  if (request.threads > 1) return "the oracle is scalar, on one thread";
  if (request.vector != "auto") return "the oracle is scalar, it uses no vectors";
  plan.vector = VectorTarget::none;
  plan.lanes = 1;
  plan.threads = 1;
  plan.law = "p = 3, q = 5 as the listing writes it, every bond from both ends";
  plan.walls =
      scene.walls.empty() ? "none" : "the X axis as the listing has it, others in their axes";
  return {};
}

}  // namespace

std::vector<KernelEntry> kernels_with_oracle(const Scene& scene) {
  const std::span<const KernelEntry> own = kernels();
  std::vector<KernelEntry> all(own.begin(), own.end());
  all.push_back({.name = "oracle",
                 .description = "the paper's listing, scalar: the reference, slow",
                 .automatic = false,
                 .memory = {.a_particle = 32.0, .an_entry = 0.0},
                 .prepare = [scene](const Problem&, const PlanRequest& request,
                                    Plan& plan) { return prepare(scene, request, plan); },
                 .make = [scene](const Problem& problem, const Plan&) -> std::unique_ptr<Stepper> {
                   return std::make_unique<OracleStepper>(scene, problem.initial);
                 }});
  return all;
}

}  // namespace bounce
