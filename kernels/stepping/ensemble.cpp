#include "kernels/stepping/ensemble.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "kernels/stepping/ensemble_batch.hpp"
#include "kernels/stepping/located.hpp"
#include "kernels/stepping/ring_forms.hpp"
#include "kernels/stepping/scene_forms.hpp"

namespace bounce {

/// One scene between its turns in a lane.
struct Ensemble::Member {
  Problem problem;
  StepStages stages;
  Snapshot now;
  bool retired = false;
  std::int64_t steps = 0;  // to be taken in this advance()

  explicit Member(Problem start)
      : problem(std::move(start)), stages(step_stages(problem)), now{problem.initial} {}
};

/// A batch and the scenes in its lanes; used by one thread at a time.
class Ensemble::Worker {
 public:
  Worker(const BatchForm& form, const State& parked, std::int64_t look_every)
      : batch_(make_batch(form)),
        look_every_(look_every),
        lanes_(batch_->lanes()),
        parked_(parked),
        read_(parked) {}
  [[nodiscard]] std::size_t lanes() const { return lanes_.size(); }

  /// Takes scenes from the queue until it is empty and they are done.
  void work(std::vector<Member>& members, std::atomic<std::size_t>& queue, const IsGood& is_good) {
    for (;;) {
      bool busy = false;
      for (std::size_t l = 0; l < lanes_.size(); ++l) {
        if (lanes_[l].member == nullptr) take(l, members, queue);
        busy = busy || lanes_[l].member != nullptr;
      }
      if (!busy) return;
      for (std::size_t l = 0; l < lanes_.size(); ++l) {
        if (lanes_[l].member == nullptr) park(l);
      }
      run_to_next_look(members.data(), is_good);
    }
  }

 private:
  struct Lane {
    Member* member = nullptr;
    std::int64_t step = 0;  // of the scene, as the batch holds it
    std::int64_t end = 0;   // the step at which it is done
    bool stage_held = false;
    bool parked = false;

    // The next step at which it is to be looked at. It depends on the scene alone, so that what a
    // scene is retired for does too.
    [[nodiscard]] std::int64_t next_look(std::int64_t every) const {
      return std::min(end, (step / every + 1) * every);
    }
  };

  void take(std::size_t l, std::vector<Member>& members, std::atomic<std::size_t>& queue) {
    for (;;) {
      const std::size_t next = queue.fetch_add(1, std::memory_order_relaxed);
      if (next >= members.size()) return;
      Member& member = members[next];
      if (member.retired || member.steps <= 0) continue;
      batch_->write(l, member.now.state, member.problem.walls);
      lanes_[l] = {&member, member.now.step, member.now.step + member.steps, member.now.stage_held};
      return;
    }
  }

  // Runs until the first scene is due, and looks at those that are.
  void run_to_next_look(const Member* members, const IsGood& is_good) {
    std::int64_t steps = look_every_;
    bool fresh = false;  // a scene for which no stage is held yet takes its first step
    for (const Lane& lane : lanes_) {
      if (lane.member == nullptr) continue;
      steps = std::min(steps, lane.next_look(look_every_) - lane.step);
      fresh = fresh || (!lane.stage_held && !lane.member->stages.joined.empty());
    }
    if (fresh) run(1);
    if (!fresh || steps > 1) run(fresh ? steps - 1 : steps);
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      const Lane& lane = lanes_[l];
      if (lane.member == nullptr) continue;
      if (lane.step == lane.end || lane.step % look_every_ == 0) {
        look(l, static_cast<std::size_t>(lane.member - members), is_good);
      }
    }
  }

  void run(std::int64_t steps) {
    std::vector<LaneStages> stages;
    for (Lane& lane : lanes_) {
      if (lane.member == nullptr) {
        stages.push_back(nullptr);
        continue;
      }
      const StepStages& of_scene = lane.member->stages;
      const bool holds_stage = !of_scene.joined.empty();
      stages.push_back(lane.stage_held ? &of_scene.joined : &of_scene.fresh);
      lane.stage_held = holds_stage;
      lane.step += steps;
    }
    batch_->run(stages, steps);
  }

  // Keeps a good state; retires a scene with another. Frees the lane of a scene that is done.
  void look(std::size_t l, std::size_t i, const IsGood& is_good) {
    Lane& lane = lanes_[l];
    Member& member = *lane.member;
    batch_->read(l, read_);
    const bool good = is_finite(read_) && (!is_good || is_good(i, completed(member, lane)));
    member.retired = !good;
    if (!member.retired) {
      std::swap(member.now.state, read_);
      member.now.step = lane.step;
      member.now.stage_held = lane.stage_held;
    }
    if (member.retired || lane.step == lane.end) lanes_[l] = {};
  }

  // The state just read with its step finished, as a user sees it.
  [[nodiscard]] State completed(const Member& member, const Lane& lane) const {
    State state = read_;
    if (lane.stage_held) finish_step(member.problem, state);
    return state;
  }

  // A lane that runs empty holds a ball that stands still, far from any wall.
  void park(std::size_t l) {
    if (lanes_[l].parked) return;
    lanes_[l].parked = true;
    batch_->write(l, parked_, {});
  }

  std::unique_ptr<EnsembleBatch> batch_;
  std::int64_t look_every_;
  std::vector<Lane> lanes_;
  State parked_;
  State read_;
};

namespace {

void check_same_kind(const Problem& problem, const Problem& first, std::size_t i) {
  const auto demand = [i](bool same, const char* what) {
    if (!same) {
      throw PlanError("an ensemble needs scenes of one kind: scene " + std::to_string(i) +
                      " (from 0) has other " + what + " than scene 0");
    }
  };
  demand(problem.law.p == first.law.p && problem.law.q == first.law.q, "exponents (p, q)");
  demand(problem.method == first.method, "stages (time.method)");
  demand(problem.initial.size() == first.initial.size(), "numbers of particles");
  demand(problem.bonds == first.bonds, "bonds");
}

BatchForm form_of(std::span<const Problem> problems, VectorTarget vector) {
  if (problems.empty()) throw PlanError("an ensemble needs one scene at least");
  const RingForm ring = find_ring_form(problems.front());
  if (!ring.refusal.empty()) throw PlanError("no ensemble of this scene: " + ring.refusal);
  for (const Problem& problem : problems) {
    if (is_located(problem.walls)) throw PlanError("an ensemble has no located contact");
    if (problem.precision == Precision::double_precision) continue;
    throw PlanError("an ensemble computes in double precision only (time.precision)");
  }
  BatchForm form{ring.shape, problems.front().law};
  form.vector = vector;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    check_same_kind(problems[i], problems.front(), i);
    form.floors_only = form.floors_only && wall_form(problems[i]) != WallForm::any;
    form.most_walls = std::max(form.most_walls, problems[i].walls.size());
  }
  return form;
}

}  // namespace

Ensemble::Ensemble(std::span<const Problem> problems, const PlanRequest& request, IsGood is_good,
                   std::int64_t look_every)
    : is_good_(std::move(is_good)), look_every_(look_every) {
  if (look_every <= 0) throw std::invalid_argument("an ensemble looks every 1 or more steps");
  const BatchForm form = form_of(problems, choose_vector(request.vector));
  members_.reserve(problems.size());
  for (const Problem& problem : problems) members_.emplace_back(problem);
  const int threads = request.threads == 0 ? omp_get_num_procs() : request.threads;
  check_threads(threads);
  for (int t = 0; t < threads; ++t) {
    workers_.push_back(std::make_unique<Worker>(form, problems.front().initial, look_every));
  }
}

Ensemble::~Ensemble() = default;

std::size_t Ensemble::size() const { return members_.size(); }
int Ensemble::lanes() const { return static_cast<int>(workers_.front()->lanes()); }
int Ensemble::threads() const { return static_cast<int>(workers_.size()); }

void Ensemble::advance(std::span<const std::int64_t> steps) {
  if (steps.size() != members_.size()) {
    throw std::invalid_argument("an ensemble of " + std::to_string(members_.size()) +
                                " scenes is given " + std::to_string(steps.size()) +
                                " numbers of steps");
  }
  for (std::size_t i = 0; i < steps.size(); ++i) members_[i].steps = steps[i];
  std::atomic<std::size_t> queue{0};
  const auto workers = static_cast<int>(workers_.size());
#pragma omp parallel for num_threads(workers) schedule(static, 1)
  for (int w = 0; w < workers; ++w) {
    workers_[static_cast<std::size_t>(w)]->work(members_, queue, is_good_);
  }
}

void Ensemble::advance(std::int64_t steps) {
  advance(std::vector<std::int64_t>(members_.size(), steps));
}

State Ensemble::state(std::size_t i) const {
  const Member& member = members_.at(i);
  State state = member.now.state;
  if (member.now.stage_held) finish_step(member.problem, state);
  return state;
}

Snapshot Ensemble::save(std::size_t i) const { return members_.at(i).now; }

void Ensemble::restore(std::size_t i, const Snapshot& snapshot) {
  members_.at(i).now = snapshot;
  members_.at(i).retired = false;
}

std::int64_t Ensemble::step(std::size_t i) const { return members_.at(i).now.step; }
bool Ensemble::retired(std::size_t i) const { return members_.at(i).retired; }

}  // namespace bounce
