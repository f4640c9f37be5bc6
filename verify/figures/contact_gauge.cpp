#include "verify/figures/contact_gauge.hpp"

namespace bounce {

ContactGauge::ContactGauge(const Problem& problem, bool again)
    : problem_(&problem),
      again_(again),
      least_flight_(least_flight(look_interval(problem))),
      walls_(problem.walls.size()) {}

void ContactGauge::begin(double time, const State& state) {
  const BallLook now = look_at(*problem_, state);
  extremes_.add_and_search(time, now, {});
  time_ = time;
  velocity_ = now.velocity;
  for (WallCourse& wall : walls_) {
    if (!wall.acted) continue;
    wall.impact->last = {time, time_rounding(time), velocity_};
    wall.acted = false;
  }
}

void ContactGauge::step(double time, const State& end, const std::function<State(double)>& again) {
  const BallLook now = look_at(*problem_, end);
  const auto look = [&](double at) { return look_at(*problem_, again(at)); };
  extremes_.add_and_search(time, now, again_ ? Extremes::LookAt(look) : Extremes::LookAt{});
  time_ = time;
  velocity_ = now.velocity;
}

void ContactGauge::contact(const ContactEvent& event) {
  WallCourse& wall = walls_[event.wall];
  const WallAct now{event.time, time_rounding(event.time), velocity_};
  if (wall.impact && wall.held == 0 && !wall.acted &&
      came_back(problem_->walls[event.wall], wall.impact->last, now, least_flight_)) {
    over_.push_back(*wall.impact);
    wall.impact.reset();
  }
  if (!wall.impact) wall.impact = Impact{event.wall, now, now};
  if (event.kind == ContactKind::lands) ++wall.held;
  if (event.kind == ContactKind::releases && wall.held > 0) --wall.held;
  wall.acted = true;
}

Bounce ContactGauge::result() const {
  Bounce bounce;
  extremes_.put_into(bounce, {});
  std::vector<Impact> impacts = over_;
  for (const WallCourse& wall : walls_) {
    if (!wall.impact) continue;
    impacts.push_back(*wall.impact);
    if (wall.held == 0) continue;
    impacts.back().last = {time_, time_rounding(time_), velocity_};
    impacts.back().acts_now = true;
  }
  add_contacts(impacts, *problem_, bounce);
  return bounce;
}

}  // namespace bounce
