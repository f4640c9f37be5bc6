#include "verify/figures/bounce.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "verify/vibrations/spectrum.hpp"

namespace bounce {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double along(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

FigurePoint depth(double time, const BallLook& look) {
  return {time, -look.centre.y, -look.velocity.y};
}
FigurePoint height(double time, const BallLook& look) {
  return {time, look.centre.y, look.velocity.y};
}
FigurePoint flattening(double time, const BallLook& look) {
  return {time, look.flattening, look.flattening_rate};
}

// A coordinate's rounding is one of the outer ring's size then, as the figure has none.
double flattening_rounding(const BallLook& look) {
  return look.radius > 0.0 ? 4.0 * epsilon * (look.farthest + look.radius) / look.radius : 0.0;
}

// Time that a set of impacts takes, and how well it is known: each end by what it was found to.
Figure time_of(std::vector<Impact> impacts) {
  std::sort(impacts.begin(), impacts.end(),
            [](const Impact& a, const Impact& b) { return a.first.time < b.first.time; });
  Figure sum;
  double until = -std::numeric_limits<double>::infinity();
  for (const Impact& impact : impacts) {
    const double from = std::max(impact.first.time, until);
    if (impact.last.time > from) sum.value += impact.last.time - from;
    sum.found_to += impact.first.found_to + impact.last.found_to;
    until = std::max(until, impact.last.time);
  }
  return sum;
}

// Newton's, of one impact.
std::optional<Figure> restitution_of(const Impact& impact, const Model& model) {
  const Wall& wall = model.walls[impact.wall];
  const double in = -along(impact.first.velocity, wall.normal);
  const double out = along(impact.last.velocity, wall.normal);
  const double pull = -along(model.gravity, wall.normal);
  const double impulse = in + out + pull * (impact.last.time - impact.first.time);
  constexpr double least_share = 0.01;
  if (impact.acts_now || !(out > 0.0) || !(in > least_share * impulse)) return std::nullopt;
  const double value = out / in;
  const double size = std::abs(impact.first.velocity.x) + std::abs(impact.first.velocity.y) +
                      std::abs(impact.last.velocity.x) + std::abs(impact.last.velocity.y);
  const double rounding = 8.0 * epsilon * size;
  return Figure{value, ((impact.last.found_to + value * impact.first.found_to) * std::abs(pull) +
                        (1.0 + value) * rounding) /
                           in};
}

}  // namespace

double look_interval(const Problem& problem) {
  constexpr double angle = 50.0;          // of the fastest vibration, between two looks
  constexpr double part = 0.02;           // of the time of a fall, or of a way
  constexpr double without_scale = 0.01;  // s
  const BallLook start = look_at(problem, problem.initial);
  const double size = 2.0 * start.radius, pull = std::hypot(problem.gravity.x, problem.gravity.y);
  double interval = std::numeric_limits<double>::infinity();
  if (const auto bound = stiffness_bound(problem, problem.initial); bound && bound->lambda > 0.0) {
    interval = angle / std::sqrt(bound->lambda);
  }
  if (pull > 0.0) interval = std::min(interval, part * std::sqrt(2.0 * size / pull));
  if (start.fastest > 0.0) interval = std::min(interval, part * size / start.fastest);
  return interval > 0.0 && std::isfinite(interval) ? interval : without_scale;
}

Figure energy_lost(const Sample& start, const Sample& now) {
  double sizes = 0.0;
  for (const Sample& sample : {start, now}) {
    sizes += std::abs(sample.kinetic) + std::abs(sample.bond) + std::abs(sample.gravity);
  }
  return {start.total() - now.total(), 2.0 * epsilon * sizes};
}

double time_rounding(double time) { return 4.0 * epsilon * std::abs(time); }
double height_rounding(const BallLook& look) { return 4.0 * epsilon * look.farthest; }

bool came_back(const Wall& wall, const WallAct& last, const WallAct& next, double least) {
  return next.time - last.time >= least && along(last.velocity, wall.normal) > 0.0 &&
         along(next.velocity, wall.normal) < 0.0;
}

double least_flight(double look_interval) { return 1.25 * look_interval; }

void add_contacts(const std::vector<Impact>& impacts, const Model& model, Bounce& bounce) {
  bounce.contact_time = time_of(impacts);
  if (impacts.empty()) return;
  const auto& first = *std::min_element(
      impacts.begin(), impacts.end(),
      [](const Impact& a, const Impact& b) { return a.first.time < b.first.time; });
  const auto& last =
      *std::max_element(impacts.begin(), impacts.end(),
                        [](const Impact& a, const Impact& b) { return a.last.time < b.last.time; });
  bounce.first_contact = Figure{first.first.time, first.first.found_to};
  bounce.last_contact = Figure{last.last.time, last.last.found_to};
  bounce.restitution = restitution_of(first, model);
}

void Extremes::after_add(double lowest_before, double rounding) {
  if (lowest_.so_far() > lowest_before + rounding) highest_.restart();
}

void Extremes::add(double time, const BallLook& look, const KeptState& from) {
  const double rounding = height_rounding(look), before = lowest_.so_far();
  lowest_.add(depth(time, look), rounding, from);
  highest_.add(height(time, look), rounding, from);
  flattest_.add(flattening(time, look), flattening_rounding(look), from);
  after_add(before, rounding);
  end_ = look;
  end_time_ = time;
}

void Extremes::add_and_search(double time, const BallLook& look, const LookAt& again) {
  const auto by = [&again](FigurePoint (*point)(double, const BallLook&)) -> LookAgain {
    if (!again) return {};
    return [&again, point](double at, const KeptState&) {
      return FigureLook{point(at, again(at)), {}};
    };
  };
  const double rounding = height_rounding(look), before = lowest_.so_far();
  lowest_.add_and_search(depth(time, look), rounding, by(depth));
  highest_.add_and_search(height(time, look), rounding, by(height));
  flattest_.add_and_search(flattening(time, look), flattening_rounding(look), by(flattening));
  after_add(before, rounding);
  end_ = look;
  end_time_ = time;
}

void Extremes::put_into(Bounce& bounce, const SeeAgain& again) const {
  const auto by = [&again](FigurePoint (*point)(double, const BallLook&)) -> LookAgain {
    if (!again) return {};
    return [&again, point](double at, const KeptState& from) {
      SeenAgain seen = again(at, from);
      return FigureLook{point(at, seen.look), std::move(seen.state)};
    };
  };
  const Greatest::Result lowest = lowest_.result(by(depth)), highest = highest_.result(by(height)),
                         flattest = flattest_.result(by(flattening));
  bounce.lowest_centre = Figure{-lowest.value, lowest.found_to};
  bounce.lowest_centre_time =
      Figure{lowest.time, lowest.time_found_to + time_rounding(lowest.time)};
  bounce.rebound_height = Figure{highest.value, highest.found_to};
  bounce.greatest_flattening = Figure{flattest.value, flattest.found_to};
  bounce.greatest_flattening_time =
      Figure{flattest.time, flattest.time_found_to + time_rounding(flattest.time)};
  bounce.end_height = Figure{end_.centre.y, height_rounding(end_)};
  bounce.end_speed =
      Figure{std::hypot(end_.velocity.x, end_.velocity.y), 4.0 * epsilon * end_.fastest};
}

}  // namespace bounce
