#include "kernels/contact/located.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "kernels/contact/contact_solver.hpp"
#include "kernels/contact/method_flow.hpp"
#include "kernels/stepping/staged_stepper.hpp"

namespace bounce {
namespace {

constexpr std::int64_t most_steps = 1 << 16;  // on the kernel inside between two looks at the walls
// Going over to the kernel inside costs a look, a restart and its last stage: as much as some
// evaluations near a wall.
constexpr std::int64_t fewest_evaluations = 32;

Model without_walls(Model model) {
  model.walls.clear();
  return model;
}

class LocatedStepper final : public Stepper {
 public:
  LocatedStepper(const Problem& problem, std::unique_ptr<Stepper> inside)
      : problem_(problem),
        open_(without_walls(problem)),
        fewest_steps_((fewest_evaluations + problem.method->evaluations - 1) /
                      problem.method->evaluations),
        inside_(std::move(inside)),
        flow_(problem_),
        solver_(problem_, flow_),
        state_(problem.initial) {}

  void advance(std::int64_t steps) override {
    while (steps > 0) {
      const std::int64_t taken = advance_inside(steps);
      if (taken == 0) step_near_wall();
      steps -= std::max<std::int64_t>(taken, 1);
    }
  }
  [[nodiscard]] State state() const override { return is_inside_ ? inside_->state() : state_; }
  [[nodiscard]] Snapshot save() const override {
    if (!is_inside_) return {state_, false, step_};
    Snapshot snapshot = inside_->save();
    snapshot.own = {static_cast<std::uint64_t>(clear_until_)};
    return snapshot;
  }
  void restore(const Snapshot& snapshot) override {
    step_ = snapshot.step;
    is_inside_ = snapshot.own.size() == 1;
    clear_until_ = is_inside_ ? static_cast<std::int64_t>(snapshot.own.front()) : -1;
    if (is_inside_) {
      inside_->restore(snapshot);
      return;
    }
    state_ = snapshot.state;
    if (snapshot.stage_held) finish_step(open_, state_);  // another kernel's
    inside_->conform(state_);
  }
  bool report_walls(std::vector<WallReport>* to) override {
    reports_ = to;
    return true;
  }
  [[nodiscard]] std::int64_t step() const override { return step_; }

 private:
  // On the kernel inside, at most `steps`. Returns how many; 0 if a wall is near.
  std::int64_t advance_inside(std::int64_t steps) {
    if (clear_until_ <= step_) {
      const std::int64_t clear = clear_steps(is_inside_ ? inside_->save().state : state_);
      if (clear < fewest_steps_) return 0;
      if (!is_inside_) inside_->restore({state_, false, step_});
      is_inside_ = true;
      clear_until_ = step_ + clear;
    }
    const std::int64_t taken = std::min(steps, clear_until_ - step_);
    inside_->advance(taken);
    step_ += taken;
    return taken;
  }

  // One step with the solver of contacts.
  void step_near_wall() {
    if (is_inside_) state_ = inside_->state();
    is_inside_ = false;
    clear_until_ = -1;
    solver_.step(problem_.step, state_);
    if (reports_ != nullptr) solver_.report(step_, problem_.step, *reports_);
    inside_->conform(state_);
    ++step_;
  }

  // For how many steps no particle can reach a wall (estimated, reason 5 in located.hpp); 0 for a
  // state that is not finite. The state may lack its last stage.
  [[nodiscard]] std::int64_t clear_steps(const State& state) {
    if (!is_finite(state)) return 0;
    const std::size_t n = state.size();
    double gap = std::numeric_limits<double>::infinity(), fastest = 0.0, strongest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      for (const Wall& wall : problem_.walls) {
        gap = std::min(gap, wall_distance(wall, state.x[i], state.y[i]));
      }
      fastest = std::max(fastest, state.vx[i] * state.vx[i] + state.vy[i] * state.vy[i]);
    }
    if (!(gap > 0.0)) return 0;
    const std::int64_t clear = whole_steps(gap / (4.0 * std::sqrt(fastest)));
    if (clear < fewest_steps_) return 0;
    pull_.resize(2 * n);
    flow_.forces()(state.x.data(), state.y.data(), pull_.data(), pull_.data() + n);
    for (std::size_t i = 0; i < n; ++i) {
      strongest = std::max(strongest, pull_[i] * pull_[i] + pull_[n + i] * pull_[n + i]);
    }
    return std::min(clear, whole_steps(std::sqrt(gap / std::sqrt(strongest))));
  }
  [[nodiscard]] std::int64_t whole_steps(double time) const {
    const double steps = time / problem_.step;
    return steps < static_cast<double>(most_steps) ? static_cast<std::int64_t>(steps) : most_steps;
  }

  Problem problem_;
  Model open_;
  std::int64_t fewest_steps_;
  std::unique_ptr<Stepper> inside_;
  MethodFlow flow_;
  ContactSolver<MethodFlow> solver_;
  State state_;                    // where not is_inside_
  std::vector<double> pull_;       // accelerations at the last look
  bool is_inside_ = false;         // the state is that of inside_
  std::int64_t clear_until_ = -1;  // step up to which no particle can reach a wall
  std::int64_t step_ = 0;
  std::vector<WallReport>* reports_ = nullptr;
};

std::string refusal_of(const Problem& problem) {
  // Whatever comes to rest on a wall with alpha = 1 slides.
  const bool slides = std::any_of(problem.walls.begin(), problem.walls.end(), [](const Wall& wall) {
    return wall.alpha == 1.0 && wall.beta != -1.0;
  });
  if (slides && problem.walls.size() > 1) {
    return "contact \"located\" does not follow a particle that slides along one wall (alpha = 1, "
           "beta above -1) into another";
  }
  return {};
}

Preparation prepare_located(const Problem& problem, const KernelRequest& request,
                            const PrepareInside& prepare_inside) {
  if (std::string why = refusal_of(problem); !why.empty()) return Refusal{why};
  const auto resolved = std::make_shared<Problem>(problem);
  for (Wall& wall : resolved->walls) wall.contact = Contact::resolved;
  Preparation inside = prepare_inside(*resolved, request);
  if (std::holds_alternative<Refusal>(inside)) return inside;
  Plan plan = std::move(std::get<Plan>(inside));
  plan.inside = plan.kernel;
  plan.cuts_steps = true;
  plan.walls = (problem.walls.size() == 1 ? "one" : std::to_string(problem.walls.size())) +
               std::string(", contact located");
  plan.reasons.emplace_back("contact located: near a wall, one thread in plain code");
  plan.make_stepper = [&problem, resolved, make = plan.make_stepper] {
    return std::make_unique<LocatedStepper>(problem, make());
  };
  return plan;
}

}  // namespace

KernelEntry located_entry() {
  return {.name = "located",
          .description = "cuts a step where a contact begins or ends; wraps another kernel",
          .wraps = true,
          .contacts = {Contact::located},
          .memory = {.a_particle = 300.0, .an_entry = 0.0},
          .prepare = prepare_located};
}

}  // namespace bounce
