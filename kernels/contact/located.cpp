#include "kernels/contact/located.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "kernels/contact/contact_course.hpp"
#include "kernels/contact/method_flow.hpp"
#include "kernels/rings/mirror_symmetry.hpp"
#include "kernels/stepping/staged_stepper.hpp"

namespace bounce {
namespace {

constexpr std::int64_t most_steps = 1 << 16;  // of a flight between two looks
// A flight costs a look, a restart and its last stage: as much as some evaluations near a wall.
constexpr std::int64_t fewest_evaluations = 32;

Problem open_problem(Problem problem) {
  problem.walls.clear();
  return problem;
}

class LocatedStepper final : public Stepper {
 public:
  LocatedStepper(const Problem& problem, bool halves,
                 const std::function<std::unique_ptr<Stepper>(const Problem&)>& make)
      : problem_(problem),
        open_(open_problem(problem)),
        fewest_steps_((fewest_evaluations + problem.method->evaluations - 1) /
                      problem.method->evaluations),
        flight_(make(open_problem(problem))),
        flow_(problem_),
        course_(problem_, flow_),
        images_(halves ? mirror_images(problem) : std::vector<std::size_t>()),
        state_(problem.initial) {}

  void advance(std::int64_t steps) override {
    while (steps > 0) {
      const std::int64_t flown = fly(steps);
      if (flown == 0) walk();
      steps -= std::max<std::int64_t>(flown, 1);
    }
  }
  [[nodiscard]] State state() const override { return flies_ ? flight_->state() : state_; }
  [[nodiscard]] Snapshot save() const override {
    if (!flies_) return {state_, false, step_};
    Snapshot snapshot = flight_->save();
    snapshot.flies_until = flies_until_;
    return snapshot;
  }
  void restore(const Snapshot& snapshot) override {
    step_ = snapshot.step;
    flies_ = snapshot.flies_until >= 0;
    flies_until_ = snapshot.flies_until;
    if (flies_) {
      flight_->restore(snapshot);
      return;
    }
    state_ = snapshot.state;
    if (snapshot.stage_held) finish_step(open_, state_);  // another kernel's
    make_symmetric(images_, state_);
  }
  [[nodiscard]] std::int64_t step() const override { return step_; }

 private:
  // In flight, at most `steps`; 0 if a wall is near.
  std::int64_t fly(std::int64_t steps) {
    if (flies_until_ <= step_) {
      const std::int64_t clear = clear_steps(flies_ ? flight_->save().state : state_);
      if (clear < fewest_steps_) return 0;
      if (!flies_) flight_->restore({state_, false, step_});
      flies_ = true;
      flies_until_ = step_ + clear;
    }
    const std::int64_t taken = std::min(steps, flies_until_ - step_);
    flight_->advance(taken);
    step_ += taken;
    return taken;
  }

  // A step near a wall.
  void walk() {
    if (flies_) state_ = flight_->state();
    flies_ = false;
    flies_until_ = -1;
    course_.step(problem_.step, state_);
    make_symmetric(images_, state_);
    ++step_;
  }

  // How many steps nobody takes to reach a wall (reason 5); 0 for a state that is not finite. The
  // state may lack its last stage.
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
  std::unique_ptr<Stepper> flight_;
  MethodFlow flow_;
  ContactCourse<MethodFlow> course_;
  std::vector<std::size_t> images_;
  State state_;                    // unless it flies
  std::vector<double> pull_;       // accelerations at the last look
  bool flies_ = false;             // the state is flight_'s
  std::int64_t flies_until_ = -1;  // step up to which nobody can reach a wall
  std::int64_t step_ = 0;
};

}  // namespace

bool is_located(const std::vector<Wall>& walls) {
  return std::any_of(walls.begin(), walls.end(),
                     [](const Wall& wall) { return wall.contact == Contact::located; });
}

std::string located_refusal(const Problem& problem) {
  if (!is_located(problem.walls)) return {};
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

Problem as_resolved(Problem problem) {
  for (Wall& wall : problem.walls) wall.contact = Contact::resolved;
  return problem;
}

std::unique_ptr<Stepper> make_located(
    const Problem& problem, bool halves,
    const std::function<std::unique_ptr<Stepper>(const Problem&)>& make) {
  return std::make_unique<LocatedStepper>(problem, halves, make);
}

}  // namespace bounce
