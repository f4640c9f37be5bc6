// Solves a motion with contacts: finds when a particle meets a wall or is pulled off it, and does
// what the rules have for that (located.hpp). Between contacts the motion is made by a Flow, which
// is a parameter: one step of it, of any length, from a given start.
//
//   attempt ----> [start ........................ end]     one step, as long as the flow likes
//   scan          which gauge crosses 0 first?             none: the step is taken
//   locate        start ......... event                    the step made anew, shorter, until its
//                                                          end is the event: Newton in a bracket
//   act           the rules; the flow begins afresh from there
//
//  1. A gauge is a number for one particle and one wall that is above 0 while nothing happens: the
//     distance of a free particle from the wall, or -a_n of one that rests there (its acceleration
//     along the normal, negative). Its slope is known, too (v_n, the jerk).
//  2. The step to an event is made from its start, not interpolated: the event is as exact as the
//     method. Interpolation (a cubic from values and slopes at both ends) only says where to look.
//  3. A gauge may cross 0 and come back within a step. Its slope then turns; where the cubic says
//     that it comes near 0, the step is cut at its lowest point and looked at there.
//  4. Several particles in a step: the earliest goes first. Those within some roundings of the time
//     (a mirror pair of a symmetric ball) go together.
//  5. A particle that has just touched a wall stands on it to rounding. It is "unarmed" until it
//     has risen by more than that, and meanwhile its gauge is raised by as much, so that roundings
//     are no contacts.
//
// The reference solutions follow a whole motion (run). Located contact takes one step at a time
// (step), each from what the state alone says, so that it can begin again anywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/contact/bond_forces.hpp"
#include "kernels/contact/contact_run.hpp"
#include "kernels/contact/resting.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// A Flow has: Real; forces(); begin(state, resting): a new start; attempt(left): a step of at most
/// `left`, returns its length, above 0; retake(h): the same step, shorter; end(): the state (4 n
/// numbers) at its end; start(); accept(): the end becomes the start; evaluations().
template <class Flow>
class ContactSolver {
 public:
  using Real = typename Flow::Real;

  ContactSolver(const Problem& problem, Flow& flow)
      : problem_(problem),
        flow_(flow),
        n_(problem.initial.size()),
        resting_(problem),
        armed_(n_ * problem.walls.size(), false),
        state_(4 * n_) {
    set(problem.initial);
    floor_ = roundings();
  }

  /// From the problem's start to the last of `times`, each of which is handed to `visit`.
  ContactRun run(std::span<const double> times,
                 const std::function<void(double, const State&)>& visit,
                 ContactWatch* watch = nullptr) {
    behind_is_refused_ = true;
    result_.height_cut = static_cast<double>(floor_);
    watch_ = watch;
    if (watch_ != nullptr) watch_->begin(0.0, rounded(now()));
    begin_at_walls();
    restart();
    tell_contacts(0);
    for (const double output : times) {
      const auto until = static_cast<Real>(output);
      while (time_ < until) advance(until);
      visit(output, rounded(start()));
    }
    result_.evaluations = flow_.evaluations();
    return std::move(result_);
  }

  /// `length` (s) from `state` on. What rests on a wall is what stands on it, does not move and is
  /// pressed to it. A particle behind a wall is put onto it (beta = -1: mirrored); one that slides
  /// into another wall goes on along that. Where more happens than can be followed, the rest of the
  /// step knows no walls.
  void step(Real length, State& state) {
    constexpr std::size_t most_events = 20'000;
    if (!is_finite(state)) return;
    time_ = 0;
    result_.events.clear();
    std::fill(armed_.begin(), armed_.end(), false);
    resting_.release_all();
    set(state);
    floor_ = roundings();
    begin_at_walls();
    restart();
    const std::size_t standing = result_.events.size();
    try {
      while (time_ < length && result_.events.size() < standing + most_events) advance(length);
      if (time_ < length) {
        flow_.attempt(length - time_);
        flow_.accept();
      }
      state = rounded(start());
    } catch (const ContactError&) {  // not finite: for the caller to see
      state = rounded(end());
    }
  }
  /// Adds what walls did in the last step(): the steps' times go from 0 to `length`.
  void report(std::int64_t step, Real length, std::vector<WallReport>& to) const {
    for (std::size_t w = 0; w < problem_.walls.size(); ++w) {
      WallReport report{.step = step, .wall = w};
      bool any = false;
      for (const ContactEvent& event : result_.events) {
        if (event.wall != w) continue;
        if (!any) report.first = event.time;
        report.last = event.time;
        any = true;
      }
      for (const std::size_t i : resting_.particles()) {
        if (resting_.wall_of(i) == static_cast<int>(w)) report.last = static_cast<double>(length);
      }
      if (any) to.push_back(report);
    }
  }

 private:
  struct Gauge {
    Real value, slope;
  };
  struct Candidate {
    std::size_t particle, wall;
    Real at;    // where the cubic says, from the step's start
    bool dips;  // it only comes near 0
  };
  using Parts = StateParts<const Real>;

  // Of a distance: of two products and two sums.
  [[nodiscard]] Real roundings(Real epsilon = std::numeric_limits<Real>::epsilon()) const {
    Real largest = 0;
    for (std::size_t k = 0; k < 2 * n_; ++k) largest = std::max(largest, std::abs(state_[k]));
    return 4 * epsilon * largest;
  }

  [[nodiscard]] Parts start() const { return {flow_.start().data(), n_}; }
  [[nodiscard]] Parts end() const { return {flow_.end().data(), n_}; }

  [[nodiscard]] Gauge distance(std::size_t i, const Wall& wall, const Parts& s) const {
    const auto nx = static_cast<Real>(wall.normal.x), ny = static_cast<Real>(wall.normal.y);
    return {nx * s.x[i] + ny * s.y[i] - static_cast<Real>(wall.offset),
            nx * s.vx[i] + ny * s.vy[i]};
  }
  [[nodiscard]] Pull<Real> pull(std::size_t i, std::size_t w, const Parts& s) const {
    return flow_.forces().pull(i, problem_.walls[w].normal, s);
  }
  [[nodiscard]] Gauge gauge(std::size_t i, std::size_t w, const Parts& s) const {
    if (resting_.wall_of(i) == static_cast<int>(w)) {
      const Pull<Real> off = pull(i, w, s);
      return {-off.acceleration, -off.jerk};
    }
    Gauge free = distance(i, problem_.walls[w], s);
    if (!armed_[i * problem_.walls.size() + w]) free.value += floor_;
    return free;
  }
  // A particle that sticks to a wall goes nowhere.
  [[nodiscard]] bool may_act(std::size_t i, std::size_t w) const {
    const int on = resting_.wall_of(i);
    return on < 0 || on == static_cast<int>(w) || resting_.slides(i);
  }

  void advance(Real until) {
    const Real left = until - time_;
    Real h = flow_.attempt(left);
    ++result_.steps;
    const bool to_the_end = h == left;
    check_finite();
    arm();
    std::optional<Candidate> event;
    // What roundings may make of events that are nearly together is no reason to go on for ever:
    // the step ends no later than any of them, and act() sees to all.
    constexpr int most_cuts = 64;
    bool cut = false;
    for (int cuts = 0; cuts < most_cuts; ++cuts) {
      const auto first = scan(h, event);
      if (!first) break;
      if (first->dips) {
        h = first->at;
        flow_.retake(h);
        event.reset();
      } else {
        h = locate(*first, h);
        event = first;
      }
      cut = true;
    }
    const Real began = time_;
    time_ = to_the_end && !cut ? until : time_ + h;
    if (watch_ != nullptr) tell_step(began, h);
    flow_.accept();
    if (!event) return;
    const std::size_t before = result_.events.size();
    act(*event);
    tell_contacts(before);
  }

  void tell_step(Real began, Real h) {
    bool made_anew = false;
    watch_->step(static_cast<double>(time_), rounded(end()), [&](double time) {
      made_anew = true;
      flow_.retake(std::clamp(static_cast<Real>(time) - began, Real(0), h));
      return rounded(end());
    });
    if (made_anew) flow_.retake(h);
  }
  // Of events from that one on, and where the motion goes on from.
  void tell_contacts(std::size_t first) {
    if (watch_ == nullptr) return;
    for (std::size_t k = first; k < result_.events.size(); ++k) watch_->contact(result_.events[k]);
    watch_->begin(static_cast<double>(time_), rounded(start()));
  }

  void arm() {
    const std::size_t walls = problem_.walls.size();
    for (std::size_t i = 0; i < n_; ++i) {
      if (resting_.wall_of(i) >= 0) continue;
      for (std::size_t w = 0; w < walls; ++w) {
        char& armed = armed_[i * walls + w];
        armed = armed || distance(i, problem_.walls[w], start()).value > floor_;
      }
    }
  }

  // The first thing that happens in the step (of length h), `known` and what goes with it apart.
  [[nodiscard]] std::optional<Candidate> scan(Real h, const std::optional<Candidate>& known) const {
    std::optional<Candidate> first;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t w = 0; w < problem_.walls.size(); ++w) {
        if (!may_act(i, w)) continue;
        const Gauge b = gauge(i, w, end());
        const bool crosses = !(b.value > 0);
        // Most are far from everything: they could not turn back within the step.
        if (!crosses && !(b.slope > 0 && b.value < b.slope * h)) continue;
        if (known && (is(*known, i, w) || (crosses && together(b)))) continue;
        const Gauge a = gauge(i, w, start());
        if (!crosses && !(a.slope < 0 && a.value < -a.slope * h)) continue;
        const Candidate found = crosses ? Candidate{i, w, root(a, b, h), false}
                                        : Candidate{i, w, lowest(a, b, h), true};
        if (!(found.at > 0) && found.dips) continue;
        if (!first || found.at < first->at) first = found;
      }
    }
    return first;
  }

  static bool is(const Candidate& c, std::size_t i, std::size_t w) {
    return c.particle == i && c.wall == w;
  }
  [[nodiscard]] Real time_rounding() const {
    return 4 * std::numeric_limits<Real>::epsilon() * std::max(Real(1), time_);
  }
  // True if the gauge is 0 within roundings of the time.
  [[nodiscard]] bool together(const Gauge& g) const {
    return std::abs(g.value) <= std::abs(g.slope) * time_rounding();
  }

  // Coefficients of the cubic p(s) = a + m s + b s^2 + c s^3, s from 0 to 1 over the step.
  struct Cubic {
    Real a, m, b, c;
    Cubic(const Gauge& from, const Gauge& to, Real h) : a(from.value), m(from.slope * h) {
      const Real rise = to.value - from.value, last = to.slope * h;
      b = 3 * rise - 2 * m - last;
      c = m + last - 2 * rise;
    }
    Real operator()(Real s) const { return a + s * (m + s * (b + s * c)); }
  };

  static Real root(const Gauge& from, const Gauge& to, Real h) {
    const Cubic p(from, to, h);
    Real lo = 0, hi = 1;
    for (int k = 0; k < 40; ++k) {
      const Real middle = (lo + hi) / 2;
      (p(middle) > 0 ? lo : hi) = middle;
    }
    return h * (lo + hi) / 2;
  }

  // Where the cubic is lowest, if it comes near 0 there and that is well within the step; else 0.
  static Real lowest(const Gauge& from, const Gauge& to, Real h) {
    const Cubic p(from, to, h);
    const Real s = -p.m / (p.b + std::sqrt(p.b * p.b - 3 * p.c * p.m));
    // The cubic is off by the fourth derivative: a tenth is ample for steps that resolve the
    // motion.
    const bool near = p(s) <= std::min(from.value, to.value) / 10;
    return near && s > Real(0.001) && s < Real(0.999) ? s * h : Real(0);
  }

  // Makes the step end where the candidate's gauge is 0; its new length.
  Real locate(const Candidate& c, Real h) {
    Real lo = 0, hi = h, at = c.at;
    for (int k = 0; k < 120; ++k) {
      flow_.retake(at);
      const Gauge g = gauge(c.particle, c.wall, end());
      if (!std::isfinite(g.value)) break;
      (g.value > 0 ? lo : hi) = at;
      const Real newton = at - g.value / g.slope;
      if (std::abs(newton - at) <= time_rounding() || hi - lo <= time_rounding()) break;
      // Roundings of a gauge may lead Newton astray: every third time the bracket is halved.
      at = k % 3 < 2 && newton > lo && newton < hi ? newton : (lo + hi) / 2;
    }
    return at;
  }

  // What happens at the end of the step just taken: the event, and what goes with it.
  void act(const Candidate& event) {
    state_ = flow_.start();
    act_on(event.particle, event.wall);
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t w = 0; w < problem_.walls.size(); ++w) {
        if (is(event, i, w) || !may_act(i, w)) continue;
        const Gauge g = gauge(i, w, now());
        if (!(g.value > 0) || (g.slope < 0 && together(g))) act_on(i, w);
      }
    }
    restart();
  }

  void act_on(std::size_t i, std::size_t w) {
    if (resting_.wall_of(i) == static_cast<int>(w)) {
      release(i, w);
    } else {
      meet(i, w);
    }
  }

  void release(std::size_t i, std::size_t w) {
    resting_.release(i);
    armed_[i * problem_.walls.size() + w] = false;
    note(i, w, ContactKind::releases);
  }

  void meet(std::size_t i, std::size_t w) {
    const Wall& wall = problem_.walls[w];
    if (resting_.wall_of(i) >= 0 && !behind_is_refused_) {  // slid into another
      resting_.release(i);
    } else if (resting_.wall_of(i) >= 0) {
      throw ContactError("particle " + std::to_string(i + 1) + " slides along wall[" +
                         std::to_string(resting_.wall_of(i)) + "] into wall[" + std::to_string(w) +
                         "] at t = " + text(time_) +
                         " s: a corner, which the reference does not solve");
    }
    const StateParts<Real> s(state_.data(), n_);
    const auto nx = static_cast<Real>(wall.normal.x), ny = static_cast<Real>(wall.normal.y);
    const Gauge at = distance(i, wall, now());
    s.x[i] -= at.value * nx;
    s.y[i] -= at.value * ny;
    const Real in = std::min(at.slope, Real(0));
    const Real out = static_cast<Real>(wall.beta) * in;
    const Real acceleration = pull(i, w, now()).acceleration;
    const bool rests = acceleration <= 0 && out * out <= -2 * acceleration * floor_;
    const Real along = ny * s.vx[i] - nx * s.vy[i];
    const Real slide = !rests              ? static_cast<Real>(wall.alpha) * along
                       : wall.alpha == 1.0 ? along
                                           : Real(0);
    const Real rise = rests ? Real(0) : out;
    s.vx[i] = ny * slide + nx * rise;
    s.vy[i] = -nx * slide + ny * rise;
    armed_[i * problem_.walls.size() + w] = false;
    if (rests) resting_.put(i, w);
    note(i, w, rests ? ContactKind::lands : ContactKind::bounces);
  }

  // Starts at a wall or behind it.
  void begin_at_walls() {
    // Where a start stands is known to the roundings of a double.
    const Real known = std::max(floor_, roundings(std::numeric_limits<double>::epsilon()));
    for (std::size_t w = 0; w < problem_.walls.size(); ++w) {
      for (std::size_t i = 0; i < n_; ++i) {
        if (may_act(i, w)) begin_at_wall(i, w, distance(i, problem_.walls[w], now()), known);
      }
    }
  }

  void begin_at_wall(std::size_t i, std::size_t w, const Gauge& at, Real known) {
    const Wall& wall = problem_.walls[w];
    const auto nx = static_cast<Real>(wall.normal.x), ny = static_cast<Real>(wall.normal.y);
    const StateParts<Real> s(state_.data(), n_);
    const bool behind = at.value < -known;
    if (behind && wall.beta == -1.0) {
      const Real along = static_cast<Real>(wall.alpha) * (ny * s.vx[i] - nx * s.vy[i]);
      s.x[i] -= 2 * at.value * nx;
      s.y[i] -= 2 * at.value * ny;
      s.vx[i] = ny * along - nx * at.slope;
      s.vy[i] = -nx * along - ny * at.slope;
    } else if (behind && behind_is_refused_) {
      throw ContactError(
          "particle " + std::to_string(i + 1) + " starts " + text(-at.value) + " cm behind wall[" +
          std::to_string(w) +
          "]: allowed is a start in front of it, or beta = -1 (the contact rules put "
          "it in different places)");
    } else if (behind && at.slope > 0) {  // on its way out
      s.x[i] -= at.value * nx;
      s.y[i] -= at.value * ny;
    } else if (at.value <= known && at.slope <= 0) {
      meet(i, w);
    }
  }

  [[nodiscard]] Parts now() const { return {state_.data(), n_}; }

  void note(std::size_t i, std::size_t w, ContactKind kind) {
    constexpr std::size_t most_events = 5'000'000;
    result_.events.push_back({static_cast<double>(time_), i, w, kind});
    if (result_.events.size() > most_events) {
      throw ContactError("more than 5 million contacts by t = " + text(time_) +
                         " s: too many to follow one by one");
    }
  }

  // From state_ on.
  void restart() {
    const StateParts<Real> s(state_.data(), n_);
    resting_.hold(s.vx, s.vy);
    flow_.begin(state_, resting_);
  }

  void check_finite() const {
    // Four sums, which do not wait for each other.
    const Parts s = end();
    Real x = 0, y = 0, vx = 0, vy = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      x += s.x[i] - s.x[i];
      y += s.y[i] - s.y[i];
      vx += s.vx[i] - s.vx[i];
      vy += s.vy[i] - s.vy[i];
    }
    if (!(x + y + vx + vy == 0)) {
      throw ContactError("no step follows the motion at t = " + text(time_) +
                         " s: a position or velocity is not finite");
    }
  }

  void set(const State& s) {
    const StateParts<Real> to(state_.data(), n_);
    for (std::size_t i = 0; i < n_; ++i) {
      to.x[i] = static_cast<Real>(s.x[i]);
      to.y[i] = static_cast<Real>(s.y[i]);
      to.vx[i] = static_cast<Real>(s.vx[i]);
      to.vy[i] = static_cast<Real>(s.vy[i]);
    }
  }

  [[nodiscard]] State rounded(const Parts& s) const {
    State state(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      state.x[i] = static_cast<double>(s.x[i]);
      state.y[i] = static_cast<double>(s.y[i]);
      state.vx[i] = static_cast<double>(s.vx[i]);
      state.vy[i] = static_cast<double>(s.vy[i]);
    }
    return state;
  }
  static std::string text(Real value) { return std::to_string(static_cast<double>(value)); }

  const Problem& problem_;
  Flow& flow_;
  std::size_t n_;
  Resting resting_;
  std::vector<char> armed_;  // by particle and wall
  std::vector<Real> state_;  // 4 n
  Real floor_ = 0;           // roundings of a distance, cm
  Real time_ = 0;
  bool behind_is_refused_ = false;
  ContactWatch* watch_ = nullptr;
  ContactRun result_;
};

}  // namespace bounce
