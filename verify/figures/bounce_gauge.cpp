#include "verify/figures/bounce_gauge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bounce {
namespace {

// Momentum, for each particle, that gravity does not explain and roundings do not: those of a
// velocity in 10^8 steps, all with one sign, and of gravity's kicks.
constexpr double velocity_share = 1e-7, gravity_share = 1e-3;

// Pieces of a course that may hold an extreme: at most 8 of a small ball.
std::size_t pieces_kept(std::size_t particles) {
  constexpr std::size_t most = 8, small_ball = 2000;
  return std::clamp<std::size_t>(most * small_ball / std::max<std::size_t>(particles, 1), 2, most);
}

std::int64_t steps_in(double interval, double step) {
  constexpr double most = 1e15;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(interval / step, most)));
}

double extremes_quantum(double time_step) {
  return time_step / static_cast<double>(ActFinder::parts_of_step);
}

double along(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

}  // namespace

ActFinder::Make remake(const Plan& plan) {
  const std::string kernel = plan.kernel == "oracle" ? "strict"  // has its bits, for any walls
                             : plan.inside.empty()   ? plan.kernel
                                                     : plan.inside;
  return [kernel](const Problem& problem) { return make_stepper(problem, {kernel, "auto", 1}); };
}

BounceGauge::BounceGauge(const Problem& problem, double time_step, ActFinder::Make make)
    : model_(std::make_shared<const Model>(problem)),
      time_step_(time_step),
      walls_(problem.walls.size()) {
  const double interval = look_interval(problem);
  least_flight_ = least_flight(interval);
  look_steps_ = steps_in(interval, problem.step);
  extremes_ = Extremes(extremes_quantum(time_step), pieces_kept(problem.initial.size()));
  if (make && problem.initial.size() <= most_kept_particles) {
    finder_ = std::make_shared<ActFinder>(problem, time_step, std::move(make));
  }
}

void BounceGauge::look(const Stepper& stepper) {
  if (ended_ || stepper.step() <= last_step()) return;
  if (!finder_) {
    look(stepper.step(), stepper.state());
    return;
  }
  KeptState kept(stepper.save());
  if (kept->stage_held) {
    look(stepper.step(), stepper.state(), kept);
  } else {
    look(stepper.step(), kept->state, kept);
  }
}

void BounceGauge::look(std::int64_t step, const State& state, KeptState kept) {
  if (ended_ || step <= last_step()) return;
  BallLook now = look_at(*model_, state);
  if (!now.is_finite()) {
    ended_ = true;
    return;
  }
  extremes_.add(time(step), now, last_ ? last_->kept : KeptState{});
  if (last_) {
    const Interval interval{last_->step, step, last_->kept, last_->ball.velocity, now.velocity};
    for (const std::size_t wall : acting(interval, last_->ball, now)) add_act(wall, interval);
  }
  last_ = Look{step, std::move(now), std::move(kept)};
}

ActFinder* BounceGauge::finder(const KeptState& start) const {
  return start ? finder_.get() : nullptr;
}

std::vector<std::size_t> BounceGauge::acting(const Interval& interval, const BallLook& before,
                                             const BallLook& now) const {
  const double length = static_cast<double>(interval.steps()) * model_->step;
  const Vec2 g = model_->gravity;
  const double pull = std::hypot(g.x, g.y), fastest = std::max(before.fastest, now.fastest);
  const double reach = 2.0 * fastest * length + pull * length * length;
  const double unexplained = std::hypot(now.velocity.x - before.velocity.x - g.x * length,
                                        now.velocity.y - before.velocity.y - g.y * length);
  const bool pushed = unexplained > gravity_share * pull * length + velocity_share * fastest;
  std::vector<std::size_t> near;
  for (std::size_t w = 0; w < model_->walls.size(); ++w) {
    if (!(std::min(before.nearest[w], now.nearest[w]) > reach)) near.push_back(w);
  }
  if (near.empty() && !pushed) return near;
  if (pushed && near.size() == 1) return near;
  ActFinder* const again = finder(interval.start);
  if (again == nullptr) return pushed ? near : std::vector<std::size_t>{};
  std::vector<std::size_t> found;
  for (std::size_t w = 0; w < model_->walls.size(); ++w) {
    const bool is_near = std::find(near.begin(), near.end(), w) != near.end();
    if ((is_near || near.empty()) && again->acts(*interval.start, interval.steps(), w)) {
      found.push_back(w);
    }
  }
  return found;
}

void BounceGauge::add_act(std::size_t wall, const Interval& interval) {
  auto& open = walls_[wall];
  if (!open) {
    open = OpenImpact{first_act(interval, wall), interval};
    return;
  }
  if (may_have_come_back(wall, open->last, interval)) {
    const WallAct last = last_act(open->last, wall), next = first_act(interval, wall);
    if (came_back(model_->walls[wall], last, next, least_flight_)) {
      over_.push_back({wall, open->first, last});
      open->first = next;
    }
  }
  open->last = interval;
}

// A flight in which the centre turns goes from the last act in one interval to the first in another;
// within each the centre's speed changes by no more than gravity makes it.
bool BounceGauge::may_have_come_back(std::size_t wall, const Interval& before,
                                     const Interval& now) const {
  const Vec2 normal = model_->walls[wall].normal;
  const double pull = std::abs(along(model_->gravity, normal)) * model_->step;
  const bool left =
      along(before.velocity_after, normal) + pull * static_cast<double>(before.steps()) > 0.0;
  const bool comes =
      along(now.velocity_before, normal) - pull * static_cast<double>(now.steps()) < 0.0;
  if (!left || !comes) return false;
  // Such a flight takes a look's time and a quarter: if the wall acts in the first eighth of this
  // interval, the flight would be all of the one before, in which the wall acts.
  ActFinder* const again = finder(now.start);
  if (before.to != now.from || again == nullptr) return before.to != now.from;
  return !again->acts(*now.start, std::max<std::int64_t>(1, now.steps() / 8), wall);
}

WallAct BounceGauge::first_act(const Interval& interval, std::size_t wall) const {
  if (ActFinder* const again = finder(interval.start)) {
    if (const auto act = again->first_act(*interval.start, interval.steps(), wall)) return *act;
  }
  const double from = time(interval.from), to = time(interval.to);
  return {0.5 * (from + to), 0.5 * (to - from), interval.velocity_before};
}

WallAct BounceGauge::last_act(const Interval& interval, std::size_t wall) const {
  if (ActFinder* const again = finder(interval.start)) {
    if (const auto act = again->last_act(*interval.start, interval.steps(), wall)) return *act;
  }
  const double from = time(interval.from), to = time(interval.to);
  return {0.5 * (from + to), 0.5 * (to - from), interval.velocity_after};
}

std::optional<double> BounceGauge::first_contact() const {
  std::optional<double> first;
  const auto take = [&first](double time) { first = first ? std::min(*first, time) : time; };
  for (const Impact& impact : over_) take(impact.first.time);
  for (const auto& open : walls_) {
    if (open) take(open->first.time);
  }
  return first;
}

Bounce BounceGauge::result() const {
  Bounce bounce;
  if (!last_) return bounce;
  const auto again = [this](double at, const KeptState& from) {
    constexpr std::int64_t parts = ActFinder::parts_of_step;
    const std::int64_t tick = std::llround(at / extremes_quantum(time_step_));
    ActFinder::Place place = finder_->go(*from, tick / parts - from->step);
    if (tick % parts > 0) place.state = finder_->part_of_step(place.state, tick % parts);
    return Extremes::SeenAgain{look_at(*model_, place.state), KeptState(std::move(place.snapshot))};
  };
  extremes_.put_into(bounce, finder_ ? Extremes::SeeAgain(again) : Extremes::SeeAgain{});
  std::vector<Impact> impacts = over_;
  const double now = time(last_->step);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (!walls_[w]) continue;
    Impact impact{w, walls_[w]->first, last_act(walls_[w]->last, w)};
    // What is held at the end is so up to then.
    impact.acts_now = impact.last.time >= now - time_rounding(now);
    if (impact.acts_now) {
      const double later = impact.last.time - now;
      impact.last.found_to = std::max(time_rounding(now), impact.last.found_to - later);
      impact.last.time = now;
    }
    impacts.push_back(impact);
  }
  add_contacts(impacts, *model_, bounce);
  return bounce;
}

}  // namespace bounce
