#include "kernels/model/scene.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kernels/model/method.hpp"

namespace bounce {
namespace {

// Bounds that no run on one machine passes; they keep index arithmetic and memory sane.
constexpr double most_particles = 5e7;
constexpr std::size_t most_radii = 1000;  // a bond class has 16 bits
constexpr double most_steps = 1e15;
constexpr double largest = 1e150;  // squares stay finite

std::string print(double x) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, x).ptr;
  return {text, end};
}
std::string print(Vec2 v) { return "[" + print(v.x) + ", " + print(v.y) + "]"; }

// Passes x only if lo <= x <= hi; a NaN does not pass.
void need(const std::string& key, double x, double lo, double hi, const std::string& allowed) {
  if (!(x >= lo && x <= hi)) throw SceneError(key, print(x), allowed);
}
void need_positive(const std::string& key, double x) {
  need(key, x, std::numeric_limits<double>::min(), largest, "a finite number above 0");
}
void need_finite(const std::string& key, Vec2 v) {
  if (!(std::abs(v.x) <= largest && std::abs(v.y) <= largest)) {
    throw SceneError(key, print(v), "two finite numbers");
  }
}

std::string indexed(const std::string& key, std::size_t i) {
  return key + "[" + std::to_string(i) + "]";
}

bool is_papers_ball(const BallSpec& ball) {
  return ball.kind == BallKind::rings && ball.per_ring == 120 &&
         ball.radii == std::vector<double>{5.0, 6.0, 7.0};
}

void validate_rings(const BallSpec& ball) {
  if (ball.spacing) {
    throw SceneError("ball.spacing", print(*ball.spacing),
                     "none for rings, which per_ring spaces; ball.kind = \"disc\" has one");
  }
  const double particles =
      static_cast<double>(ball.per_ring) * static_cast<double>(ball.radii.size());
  if (ball.per_ring < 3 || !(particles <= most_particles)) {
    throw SceneError("ball.per_ring", std::to_string(ball.per_ring),
                     "3 or more, and at most 50 million particles in all");
  }
}

void validate_disc(const BallSpec& ball) {
  if (ball.radii.size() != 1) {
    throw SceneError("ball.radii", std::to_string(ball.radii.size()) + " radii",
                     "the one radius of a disc");
  }
  if (!ball.spacing) {
    throw SceneError("ball.spacing", "nothing", "the spacing of the disc's particles, cm");
  }
  // A lattice particle has spacing^2 sqrt(3)/2 of the area.
  const double radius = ball.radii.front() / *ball.spacing;
  const double particles = 2.0 * std::numbers::pi / std::numbers::sqrt3 * radius * radius;
  if (!(*ball.spacing > 0.0 && radius >= 1.0 && particles <= most_particles)) {
    throw SceneError("ball.spacing", print(*ball.spacing),
                     "above 0, at most the radius, and at most 50 million particles in all");
  }
}

void validate_ball(const BallSpec& ball) {
  if (ball.radii.empty()) throw SceneError("ball.radii", "[]", "at least one radius");
  if (ball.radii.size() > most_radii) {
    throw SceneError("ball.radii", std::to_string(ball.radii.size()) + " radii",
                     "1 to " + std::to_string(most_radii) + " radii");
  }
  for (std::size_t i = 0; i < ball.radii.size(); ++i) {
    need_positive(indexed("ball.radii", i), ball.radii[i]);
    if (i > 0 && !(ball.radii[i] > ball.radii[i - 1])) {
      throw SceneError(indexed("ball.radii", i), print(ball.radii[i]),
                       "more than the radius before it, " + print(ball.radii[i - 1]));
    }
  }
  if (ball.kind == BallKind::rings) {
    validate_rings(ball);
  } else {
    validate_disc(ball);
  }
  need_finite("ball.centre", ball.centre);
  need_finite("ball.velocity", ball.velocity);
}

void validate_law(const LawSpec& law, const BallSpec& ball) {
  need("law.p", law.p, 1e-3, 63.0, "0.001 to 63");
  need("law.q", law.q, 1e-3, 64.0, "more than p, at most 64");
  if (!(law.q > law.p)) throw SceneError("law.q", print(law.q), "more than p = " + print(law.p));
  need_positive("law.elasticity", law.elasticity);
  if (law.rest == Rest::listing && !is_papers_ball(ball)) {
    throw SceneError("law.rest", "\"listing\"",
                     "\"geometry\" for this ball: the listing's constants are those of radii "
                     "5, 6, 7 with 120 particles a ring");
  }
}

void validate_walls(const std::vector<Wall>& walls) {
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& wall = walls[i];
    const std::string key = indexed("wall", i);
    need_finite(key + ".normal", wall.normal);
    const double length = std::hypot(wall.normal.x, wall.normal.y);
    if (!(std::abs(length - 1.0) <= 1e-6)) {  // six digits typed by hand pass, and are made exact
      throw SceneError(key + ".normal", print(wall.normal), "a vector of length 1");
    }
    need(key + ".offset", wall.offset, -largest, largest, "a finite number");
    need(key + ".alpha", wall.alpha, 0.0, 1.0, "0 (full friction) to 1 (frictionless)");
    need(key + ".beta", wall.beta, -1.0, 0.0, "-1 (elastic) to 0");
    if ((wall.contact == Contact::located) != (walls.front().contact == Contact::located)) {
      throw SceneError(key + ".contact", wall.contact == Contact::located ? "located" : "another",
                       "located for all walls or for none, as it cuts the steps of the whole ball");
    }
  }
}

void validate_output(const OutputSpec& output, const TimeSpec& time) {
  if (output.frames_every && !output.frames_at.empty()) {
    throw SceneError("output.frames_at", "a list beside frames_every", "one of the two keys");
  }
  if (output.frames_every) {
    need("output.frames_every", *output.frames_every, time.step, largest,
         "at least one step, time.step = " + print(time.step) + " s");
  }
  for (std::size_t i = 0; i < output.frames_at.size(); ++i) {
    need(indexed("output.frames_at", i), output.frames_at[i], 0.0, time.end * (1.0 + 1e-9),
         "0 to time.end = " + print(time.end));
  }
  need("output.monitor_every", output.monitor_every, time.step, largest,
       "at least one step, time.step = " + print(time.step) + " s");
}

}  // namespace

SceneError::SceneError(std::string at_key, std::string found, std::string may_be)
    : std::invalid_argument(at_key + " = " + found + ": allowed is " + may_be),
      key(std::move(at_key)),
      value(std::move(found)),
      allowed(std::move(may_be)) {}

std::int64_t Scene::steps_until(double t) const { return std::llround(t / time.step); }

void validate(const Scene& scene) {
  validate_ball(scene.ball);
  validate_law(scene.law, scene.ball);
  need_finite("gravity.acceleration", scene.gravity);
  validate_walls(scene.walls);
  need_positive("time.step", scene.time.step);
  need_positive("time.end", scene.time.end);
  if (!(scene.time.end / scene.time.step <= most_steps)) {
    throw SceneError("time.end", print(scene.time.end), "at most 1e15 steps");
  }
  if (find_method(scene.time.method) == nullptr) {
    std::string names;
    for (const Method& method : methods()) {
      names += (names.empty() ? "" : ", ") + std::string(method.name);
    }
    throw SceneError("time.method", "\"" + scene.time.method + "\"", "one of: " + names);
  }
  validate_output(scene.output, scene.time);
}

}  // namespace bounce
