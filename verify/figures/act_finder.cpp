#include "verify/figures/act_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bounce {
namespace {

// Roundings of a distance from a wall: two products, two sums, and those of the coordinates.
constexpr double distance_roundings = 16.0;
// A held particle hovers above the wall by what gravity and bonds move it in a step, a_n dt^2; a
// method of several stages by some times as much.
constexpr double hover = 4.0;
// Steps after the last act in which a held particle may still be pressed: with the paper's rule it
// hovers, and is mirrored every other step.
constexpr int steps_to_release = 8;

bool same(const Snapshot& a, const Snapshot& b) {
  return a.state.y == b.state.y && a.state.vy == b.state.vy && a.state.x == b.state.x &&
         a.state.vx == b.state.vx;
}

Vec2 centre_velocity(const State& s) {
  Vec2 sum;
  for (std::size_t i = 0; i < s.size(); ++i) {
    sum.x += s.vx[i];
    sum.y += s.vy[i];
  }
  const auto n = static_cast<double>(s.size());
  return {sum.x / n, sum.y / n};
}

// A distance and its rate before and after a step of length h.
struct Approach {
  double before, rate_before, after, rate_after, h;

  [[nodiscard]] double cubic(double u) const {
    const double m = rate_before * h, last = rate_after * h, rise = after - before;
    return before + u * (m + u * ((3.0 * rise - 2.0 * m - last) + u * (m + last - 2.0 * rise)));
  }
  [[nodiscard]] double parabola(double u) const {
    const double m = rate_before * h;
    return before + u * (m + u * (after - before - m));
  }
  // When it comes to 0, by the cubic; a parabola, which has one number less, tells how well.
  [[nodiscard]] ActFinder::Within comes_to_zero() const {
    const double exact = root([this](double u) { return cubic(u); });
    const double rough = root([this](double u) { return parabola(u); });
    return {exact * h, std::abs(exact - rough) * h};
  }
  // u from 0 to 1.
  template <class Path>
  static double root(const Path& path) {
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (path(middle) > 0.0 ? low : high) = middle;
    }
    return high;
  }
};

}  // namespace

ActFinder::ActFinder(Problem problem, double time_step, Make make)
    : problem_(std::move(problem)),
      time_step_(time_step),
      make_(std::move(make)),
      forces_(problem_),
      without_(problem_.walls.size()) {}

Stepper& ActFinder::with_walls() {
  if (!with_) {
    with_ = make_(problem_);
    reports_ = with_->report_walls(&reported_);
  }
  reported_.clear();
  return *with_;
}

Stepper& ActFinder::without(std::size_t wall) {
  if (!without_[wall]) {
    Problem open = problem_;
    open.walls.erase(open.walls.begin() + static_cast<std::ptrdiff_t>(wall));
    without_[wall] = make_(open);
  }
  return *without_[wall];
}

bool ActFinder::reports() {
  with_walls();
  return reports_;
}

ActFinder::Place ActFinder::go(const Snapshot& from, std::int64_t steps) {
  Stepper& stepper = with_walls();
  stepper.restore(from);
  stepper.advance(steps);
  return {stepper.save(), stepper.state()};
}

State ActFinder::part_of_step(const State& start, std::int64_t parts) {
  if (!fine_) {
    Problem fine = problem_;
    fine.step /= static_cast<double>(parts_of_step);
    fine_ = make_(fine);
  }
  fine_->restore({start, false, 0, {}});
  fine_->advance(parts);
  return fine_->state();
}

std::vector<WallReport> ActFinder::reports_of(const Snapshot& from, std::int64_t steps,
                                              std::size_t wall) {
  go(from, steps);
  std::vector<WallReport> found;
  std::copy_if(reported_.begin(), reported_.end(), std::back_inserter(found),
               [wall](const WallReport& each) { return each.wall == wall; });
  return found;
}

bool ActFinder::acts(const Snapshot& from, std::int64_t steps, std::size_t wall) {
  return before_first(from, steps, wall).has_value();
}

// In blocks that double, and the block in which the bits part by bisection.
std::optional<Snapshot> ActFinder::before_first(const Snapshot& from, std::int64_t steps,
                                                std::size_t wall) {
  if (reports()) {
    const std::vector<WallReport> all = reports_of(from, steps, wall);
    if (all.empty()) return std::nullopt;
    return go(from, all.front().step - from.step).snapshot;
  }
  Stepper &here = with_walls(), &open = without(wall);
  Snapshot low = from;
  std::int64_t block = 1, left = steps;
  for (bool narrows = false; left > 0;) {
    block = narrows ? std::max<std::int64_t>(1, left / 2) : std::min(2 * block, left);
    here.restore(low);
    open.restore(low);
    here.advance(block);
    open.advance(block);
    Snapshot reached = here.save();
    if (same(reached, open.save())) {
      low = std::move(reached);
      left -= block;
    } else if (block == 1) {
      return low;
    } else {
      narrows = true;
      left = block;
    }
  }
  return std::nullopt;
}

std::optional<Snapshot> ActFinder::before_last(const Snapshot& from, std::int64_t steps,
                                               std::size_t wall) {
  if (reports()) {
    const std::vector<WallReport> all = reports_of(from, steps, wall);
    if (all.empty()) return std::nullopt;
    return go(from, all.back().step - from.step).snapshot;
  }
  Stepper &here = with_walls(), &open = without(wall);
  here.restore(from);
  here.advance(steps);
  const Snapshot end = here.save();
  const auto acts_after = [&](const Snapshot& at) {
    open.restore(at);
    open.advance(from.step + steps - at.step);
    return !same(end, open.save());
  };
  if (!acts_after(from)) return std::nullopt;
  Snapshot low = from;  // acts after it
  for (std::int64_t high = from.step + steps; high - low.step > 1;) {
    here.restore(low);
    here.advance((high - low.step) / 2);
    Snapshot middle = here.save();
    if (acts_after(middle)) {
      low = std::move(middle);
    } else {
      high = middle.step;
    }
  }
  return low;
}

Pull<double> ActFinder::pull_on(std::size_t particle, std::size_t wall, const State& state) const {
  const std::size_t n = state.size();
  // The forces want one array; a particle's own neighbours are all that is read of it.
  std::vector<double> all(4 * n);
  const auto put = [&](std::size_t i) {
    all[i] = state.x[i];
    all[n + i] = state.y[i];
    all[2 * n + i] = state.vx[i];
    all[3 * n + i] = state.vy[i];
  };
  put(particle);
  problem_.bonds.visit_row(particle, [&](std::size_t j, std::size_t) { put(j); });
  return forces_.pull(particle, problem_.walls[wall].normal, {all.data(), n});
}

// A particle that the wall has held up to the step after `before`: when it is pulled off.
std::optional<ActFinder::Within> ActFinder::release(std::size_t particle, std::size_t wall,
                                                    const Snapshot& before, Pull<double> pull) {
  const double h = problem_.step;
  // By the paper's rule what is held hovers, and is not mirrored in each step: another particle may
  // have been held longer than those that were mirrored last.
  const double hovering = problem_.walls[wall].contact == Contact::listing ? 2.0 * h : 0.0;
  Snapshot at = before;
  for (int k = 0; k < steps_to_release; ++k) {
    Place next = go(at, 1);
    const Pull<double> then = pull_on(particle, wall, next.state);
    if (then.acceleration > 0.0) {
      const Approach way{-pull.acceleration, -pull.jerk, -then.acceleration, -then.jerk, h};
      const Within found = way.comes_to_zero();
      return Within{k * h + found.time, found.found_to + hovering};
    }
    pull = then;
    at = std::move(next.snapshot);
  }
  return std::nullopt;
}

ActFinder::Within ActFinder::within_step(const Snapshot& before, std::size_t wall, Which which) {
  const double h = problem_.step;
  const Wall& plane = problem_.walls[wall];
  const Place start = go(before, 0), met = go(before, 1);
  Stepper& open = without(wall);
  open.restore(before);
  open.advance(1);
  const State passed = open.state();
  std::optional<Within> found;
  for (std::size_t i = 0; i < passed.size(); ++i) {
    if (passed.y[i] == met.state.y[i] && passed.x[i] == met.state.x[i] &&
        passed.vy[i] == met.state.vy[i] && passed.vx[i] == met.state.vx[i]) {
      continue;
    }
    const auto rate = [&](const State& s) {
      return plane.normal.x * s.vx[i] + plane.normal.y * s.vy[i];
    };
    const Approach way{wall_distance(plane, start.state.x[i], start.state.y[i]), rate(start.state),
                       wall_distance(plane, passed.x[i], passed.y[i]), rate(passed), h};
    const double rounding =
        distance_roundings * std::numeric_limits<double>::epsilon() *
        (std::abs(passed.x[i]) + std::abs(passed.y[i]) + std::abs(plane.offset));
    if (way.after > rounding) continue;  // a neighbour of one that was met
    const Pull<double> pull = pull_on(i, wall, start.state);
    const double strength = std::abs(pull.acceleration);
    const bool stands = way.before <= rounding + hover * strength * h * h &&
                        std::abs(way.rate_before) <= hover * strength * h;
    Within here{0.0, which == Which::first ? 0.0 : h};
    if (stands && pull.acceleration < 0.0 && which == Which::last) {
      const double late = steps_to_release * h;
      here = release(i, wall, before, pull).value_or(Within{late, late - h});
    } else if (way.before > rounding && !stands) {
      here = way.comes_to_zero();
    }
    const bool counts =
        !found || (which == Which::first ? here.time < found->time : here.time > found->time);
    if (counts) found = here;
  }
  // Met in the midst of a step of several stages, and not behind the wall at its end.
  return found.value_or(Within{0.5 * h, 0.5 * h});
}

WallAct ActFinder::act_at(const Snapshot& before, const Within& within, Which which) {
  const bool first = which == Which::first;
  const State state = first ? go(before, 0).state : go(before, 1).state;
  const double flight = within.time - (first ? 0.0 : problem_.step);
  const Vec2 v = centre_velocity(state);
  // Times are said in the nominal step.
  const double start = static_cast<double>(before.step) * time_step_;
  return {start + within.time * (time_step_ / problem_.step),
          within.found_to + 4.0 * std::numeric_limits<double>::epsilon() * (start + problem_.step),
          {v.x + problem_.gravity.x * flight, v.y + problem_.gravity.y * flight}};
}

std::optional<WallAct> ActFinder::first_act(const Snapshot& from, std::int64_t steps,
                                            std::size_t wall) {
  const auto before = before_first(from, steps, wall);
  if (!before) return std::nullopt;
  const Within within = reports() ? Within{reports_of(*before, 1, wall).front().first, 0.0}
                                  : within_step(*before, wall, Which::first);
  return act_at(*before, within, Which::first);
}

std::optional<WallAct> ActFinder::last_act(const Snapshot& from, std::int64_t steps,
                                           std::size_t wall) {
  const auto before = before_last(from, steps, wall);
  if (!before) return std::nullopt;
  const Within within = reports() ? Within{reports_of(*before, 1, wall).back().last, 0.0}
                                  : within_step(*before, wall, Which::last);
  return act_at(*before, within, Which::last);
}

}  // namespace bounce
