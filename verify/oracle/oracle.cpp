#include "verify/oracle/oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "kernels/model/wall_rule.hpp"

namespace bounce {
namespace {

constexpr std::size_t particles = 360;

using RestSquares = std::array<double, 5>;  // R0^2, cm^2: 11, 12, 22, 23, 33

// The listing's constants, 1096.64, 16328, 1578.4, 16462.8 and 2148.8, over its E = 16000.
constexpr RestSquares listing_rest{0.06854, 1.0205, 0.09865, 1.028925, 0.1343};

// Squared distances of neighbours on the exact circles. In long double and rounded once, so that
// the value does not depend on how the formula is written.
RestSquares exact_rest(const std::vector<double>& radii) {
  constexpr long double half = std::numbers::pi_v<long double> / 120.0L;
  const auto ring = [](long double r) {
    return static_cast<double>(4.0L * r * r * std::sin(half) * std::sin(half));
  };
  const auto cross = [](long double r, long double s) {
    return static_cast<double>(r * r + s * s - 2.0L * r * s * std::cos(half));
  };
  return {ring(radii[0]), cross(radii[0], radii[1]), ring(radii[1]), cross(radii[1], radii[2]),
          ring(radii[2])};
}

// A literal as the scene wants it stored. The product E R0^2 of two doubles is within one rounding
// of the author's decimal product, so its single-precision rounding is that of his digits.
//
// volatile, because GCC 12.2 from -O2 on drops the rounding where two of these stand side by side
// (its SLP vectoriser takes double -> float -> double of a pair for a copy).
double literal(const Scene& scene, double value) {
  if (scene.constants == Constants::double_precision) return value;
  const volatile auto single = static_cast<float>(value);
  return static_cast<double>(single);
}

// Normals typed with few digits are made unit length.
Wall with_unit_normal(Wall wall) {
  const double length = std::hypot(wall.normal.x, wall.normal.y);
  wall.normal = {wall.normal.x / length, wall.normal.y / length};
  return wall;
}

}  // namespace

std::string Oracle::refusal(const Scene& scene) {
  const BallSpec& ball = scene.ball;
  if (ball.radii.size() != 3 || ball.per_ring != 120) {
    return "the listing has 3 rings of 120 particles, this ball " +
           std::to_string(ball.radii.size()) + " of " + std::to_string(ball.per_ring);
  }
  if (!(scene.law.p == 3.0 && scene.law.q == 5.0)) return "the listing has the law p = 3, q = 5";
  if (scene.law.rest == Rest::listing && ball.radii != std::vector<double>{5.0, 6.0, 7.0}) {
    return "the listing's rest lengths are those of radii 5, 6, 7 (rest = \"geometry\" for others)";
  }
  if (scene.time.method != "listing") {
    return "the listing has its own method, not \"" + scene.time.method + "\"";
  }
  if (any_resolved(scene.walls)) return "the listing's walls are those of contact \"listing\"";
  return {};
}

Oracle::Oracle(const Scene& scene, const State& start, RunListing run) : run_(run) {
  if (const std::string why = refusal(scene); !why.empty()) throw std::invalid_argument(why);
  const double e = scene.law.elasticity;
  const RestSquares rest =
      scene.law.rest == Rest::listing ? listing_rest : exact_rest(scene.ball.radii);
  listing_.e = literal(scene, e);
  listing_.h11 = literal(scene, e * rest[0]);
  listing_.h12 = literal(scene, e * rest[1]);
  listing_.h22 = literal(scene, e * rest[2]);
  listing_.h23 = literal(scene, e * rest[3]);
  listing_.h33 = literal(scene, e * rest[4]);
  listing_.gx = literal(scene, scene.gravity.x);
  listing_.gy = literal(scene, scene.gravity.y);
  listing_.dt = literal(scene, scene.time.step);
  for (const Wall& wall : scene.walls) walls_.push_back(with_unit_normal(wall));
  set_state(start);
}

void Oracle::set_state(const State& state) {
  if (state.size() != particles || state.y.size() != particles || state.vx.size() != particles ||
      state.vy.size() != particles) {
    throw std::invalid_argument("the listing has 360 particles, this state " +
                                std::to_string(state.size()));
  }
  std::copy(state.x.begin(), state.x.end(), listing_.x + 1);
  std::copy(state.y.begin(), state.y.end(), listing_.y + 1);
  std::copy(state.vx.begin(), state.vx.end(), listing_.vx + 1);
  std::copy(state.vy.begin(), state.vy.end(), listing_.vy + 1);
}

void Oracle::step(std::int64_t steps) { run_(listing_, walls_, steps); }

State Oracle::state() const {
  State state(particles);
  std::copy_n(listing_.x + 1, particles, state.x.begin());
  std::copy_n(listing_.y + 1, particles, state.y.begin());
  std::copy_n(listing_.vx + 1, particles, state.vx.begin());
  std::copy_n(listing_.vy + 1, particles, state.vy.begin());
  return state;
}

}  // namespace bounce
