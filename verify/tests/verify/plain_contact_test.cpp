// Contacts judged by what shares no code with them: one particle's path in closed form, and two
// particles with a bond taken through the paper's own rule in a million tiny steps. Stepper
// (contact located, resolved) and references find their contacts by code of which they share parts;
// what is wrong in all of them alike shows here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/model/method.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/accuracy/reference_solution.hpp"

namespace bounce {
namespace {

constexpr double end = 1.0;  // s

// ---- who is judged

struct Way {
  std::string name;
  bool reference;  // it has no steps, and takes no start behind a wall unless beta = -1
  Contact contact;
  double step;  // s
};

void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

std::vector<Way> ways() {
  return {{"adaptive", true, Contact::located, 0.0},
          {"fixed", true, Contact::located, 0.0},
          {"located", false, Contact::located, 1e-3},
          {"resolved", false, Contact::resolved, 1e-5}};
}

State solve(const Way& way, Problem problem) {
  problem.method = find_method(way.contact == Contact::located ? "blanes-moan-6" : "leapfrog");
  problem.step = way.step;
  for (Wall& wall : problem.walls) wall.contact = way.contact;
  State found;
  const auto keep = [&](double, const State& state) { found = state; };
  const std::vector<double> times{end};
  if (way.name == "adaptive") {
    solve_adaptive(problem, times, AdaptiveSettings{}, keep);
  } else if (way.name == "fixed") {
    solve_fixed(problem, times, FixedSettings{1e-3}, keep);
  } else {
    const auto stepper = make_stepper(problem, {"csr", "auto", 1});
    stepper->advance(std::llround(end / way.step));
    found = stepper->state();
  }
  return found;
}

// ---- one particle

struct Place {
  Vec2 x, v;
};

double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

// The paper's rule: the tangential velocity times alpha, the normal one times beta.
Vec2 after_impact(const Wall& wall, Vec2 v) {
  const double normal = dot(v, wall.normal);
  const Vec2 n = wall.normal;
  return {wall.alpha * (v.x - normal * n.x) + wall.beta * normal * n.x,
          wall.alpha * (v.y - normal * n.y) + wall.beta * normal * n.y};
}

Place flown(Place from, Vec2 g, double t) {
  return {
      {from.x.x + from.v.x * t + 0.5 * g.x * t * t, from.x.y + from.v.y * t + 0.5 * g.y * t * t},
      {from.v.x + g.x * t, from.v.y + g.y * t}};
}

// When a particle at the distance d, rising at v, falling by -a, is on the wall next; more than
// `left` if not by then.
double time_to(double d, double v, double a, double left) {
  double first = std::numeric_limits<double>::infinity();
  if (a == 0.0) return v < 0.0 ? -d / v : first;
  const double root = v * v - 2.0 * a * d;
  if (root < 0.0) return first;
  for (const double sign : {-1.0, 1.0}) {
    const double t = (-v + sign * std::sqrt(root)) / a;
    if (t > 1e-9 && t < first) first = t;
  }
  return first < left ? first : std::numeric_limits<double>::infinity();
}

// A particle and one wall from t = 0 to `end`. It may begin behind an elastic wall: the paper's rule
// then mirrors it in its first step. It must not come to rest but on a wall with beta = 0, where it
// sticks, or slides if alpha is 1.
Place path(const Problem& problem) {
  const Wall& wall = problem.walls.front();
  Place at{{problem.initial.x[0], problem.initial.y[0]},
           {problem.initial.vx[0], problem.initial.vy[0]}};
  const auto distance = [&](const Place& p) { return dot(p.x, wall.normal) - wall.offset; };
  if (const double d = distance(at); d < 0.0) {
    at.x = {at.x.x - 2.0 * d * wall.normal.x, at.x.y - 2.0 * d * wall.normal.y};
    at.v = after_impact(wall, at.v);
  }
  const double pull = dot(problem.gravity, wall.normal);
  double left = end;
  // One that starts on the wall and moves at it meets it at once.
  if (distance(at) == 0.0 && dot(at.v, wall.normal) < 0.0) at.v = after_impact(wall, at.v);
  for (int impacts = 0; impacts < 100; ++impacts) {
    const double v = dot(at.v, wall.normal);
    const double d = std::max(distance(at), 0.0);
    if (d < 1e-12 && std::abs(v) < 1e-12 && pull <= 0.0) {  // it rests
      const Vec2 along{wall.normal.y, -wall.normal.x};
      const double a = wall.alpha == 1.0 ? dot(problem.gravity, along) : 0.0;
      const double w = wall.alpha == 1.0 ? dot(at.v, along) : 0.0;
      const double way = w * left + 0.5 * a * left * left;
      return {{at.x.x + way * along.x, at.x.y + way * along.y},
              {(w + a * left) * along.x, (w + a * left) * along.y}};
    }
    const double t = time_to(d, v, pull, left);
    if (!(t < left)) return flown(at, problem.gravity, left);
    at = flown(at, problem.gravity, t);
    at.v = after_impact(wall, at.v);
    left -= t;
  }
  ADD_FAILURE() << "a hundred impacts: this path is for other tests";
  return at;
}

// The particle, and far away two more at rest with a bond, as kernels want one.
Problem one_particle(const Wall& wall, Vec2 gravity, double distance, double in, double along) {
  Problem problem;
  problem.bonds = BondList{{0, 0, 1, 2}, {2, 1}, {0, 0}};
  problem.law = {3.0, 5.0};
  problem.classes = {{1.0, 1.0, 1.0}};
  problem.gravity = gravity;
  problem.walls = {wall};
  problem.initial = State(3);
  const Vec2 n = wall.normal, t{n.y, -n.x};
  const double heights[3] = {wall.offset + distance, wall.offset + 30.0, wall.offset + 30.0};
  const double places[3] = {0.3, 0.0, 1.0};
  for (std::size_t i = 0; i < 3; ++i) {
    problem.initial.x[i] = heights[i] * n.x + places[i] * t.x;
    problem.initial.y[i] = heights[i] * n.y + places[i] * t.y;
  }
  problem.initial.vx[0] = -in * n.x + along * t.x;
  problem.initial.vy[0] = -in * n.y + along * t.y;
  return problem;
}

class PlainContact : public testing::TestWithParam<Way> {
 protected:
  // What is allowed: roundings of some hundred steps, amplified by a few impacts; a start on the
  // wall is on it to a rounding only. Resolved contact: what the drift's straight line leaves of
  // the way at each of a few impacts, half g dt^2, and of the velocity g dt.
  [[nodiscard]] double close() const {
    return GetParam().contact == Contact::resolved ? 1e-3 : 1e-10;
  }
  void expect_path(const Problem& problem, const std::string& what) const {
    SCOPED_TRACE(what);
    const Place right = path(problem);
    const State found = solve(GetParam(), problem);
    EXPECT_NEAR(found.x[0], right.x.x, close());
    EXPECT_NEAR(found.y[0], right.x.y, close());
    EXPECT_NEAR(found.vx[0], right.v.x, close());
    EXPECT_NEAR(found.vy[0], right.v.y, close());
  }
};

const std::vector<Vec2>& normals() {
  static const std::vector<Vec2> all{{0.0, 1.0}, {0.0, -1.0}, {1.0, 0.0},
                                     {0.6, 0.8}, {-0.8, 0.6}, {0.28, -0.96}};
  return all;
}

std::string named(const char* start, Vec2 n, double alpha, double beta) {
  return std::string(start) + ", normal " + std::to_string(n.x) + " " + std::to_string(n.y) +
         ", alpha " + std::to_string(alpha) + ", beta " + std::to_string(beta);
}

// With the pull towards the wall or away from it, wherever it faces.
TEST_P(PlainContact, OneParticleTakesItsPath) {
  for (const Vec2 n : normals()) {
    for (const double alpha : {0.0, 0.3, 1.0}) {
      for (const double beta : {0.0, -0.4, -1.0}) {
        const Wall wall{n, -0.7, alpha, beta};
        const Vec2 pull{-3.0 * n.x + 0.5 * n.y, -3.0 * n.y - 0.5 * n.x};
        const Vec2 none{};
        // With neither pull nor bounce roundings say whether it still touches in the next step.
        const bool clear = beta < 0.0 || alpha == 0.0 || GetParam().contact != Contact::resolved;
        if (clear) {
          expect_path(one_particle(wall, none, 0.2, 1.0, 0.7), named("free", n, alpha, beta));
          expect_path(one_particle(wall, none, 0.0, 1.0, 0.7), named("on it", n, alpha, beta));
        }
        // At beta = -0.4 it would hop ever lower by 1 s: it starts higher.
        expect_path(one_particle(wall, pull, 0.9, 0.5, 0.7), named("pulled", n, alpha, beta));
      }
    }
  }
}

// What stepper and references share: a start behind an elastic wall is mirrored, and its tangential
// velocity multiplied by alpha.
TEST_P(PlainContact, AStartBehindAnElasticWallIsMirroredWithItsAlpha) {
  for (const Vec2 n : normals()) {
    for (const double alpha : {0.0, 0.3, 1.0}) {
      const Wall wall{n, -0.7, alpha, -1.0};
      for (const double in : {1.0, -1.0}) {  // on its way in, and out
        expect_path(one_particle(wall, {}, -5e-5, in, 0.7), named("behind", n, alpha, -1.0));
      }
    }
  }
}

// ---- two particles and a bond

Problem two_particles(const Wall& wall, double tilt) {
  Problem problem = one_particle(wall, {0.4, -3.0}, 0.0, 0.0, 0.0);
  problem.bonds = BondList{{0, 1, 2}, {1, 0}, {0, 0}};
  problem.classes = {{40.0, 40.0, 1.0}};
  problem.initial = State(2);
  // The lower one `0.05` above the wall, the other one 1.1 away.
  problem.initial.x = {0.0, 1.1 * std::sin(tilt)};
  problem.initial.y = {0.05, 0.05 + 1.1 * std::cos(tilt)};
  problem.initial.vx = {0.3, 0.1};
  problem.initial.vy = {-0.5, -0.9};
  return problem;
}

// The paper's step, as its text says: kick, drift, mirror.
void paper_steps(const Problem& problem, double dt, std::int64_t steps, State& s) {
  const BondClass& bond = problem.classes.front();
  const Wall& wall = problem.walls.front();
  for (std::int64_t k = 0; k < steps; ++k) {
    const double dx = s.x[1] - s.x[0], dy = s.y[1] - s.y[0];
    const double u = 1.0 / (dx * dx + dy * dy);
    const double f = u * u * (bond.repulsion * u - bond.attraction);
    s.vx[0] += dt * (problem.gravity.x - f * dx);
    s.vy[0] += dt * (problem.gravity.y - f * dy);
    s.vx[1] += dt * (problem.gravity.x + f * dx);
    s.vy[1] += dt * (problem.gravity.y + f * dy);
    for (std::size_t i = 0; i < 2; ++i) {
      s.x[i] += dt * s.vx[i];
      s.y[i] += dt * s.vy[i];
      const double d = wall.normal.x * s.x[i] + wall.normal.y * s.y[i] - wall.offset;
      if (d > 0.0) continue;
      s.x[i] -= 2.0 * d * wall.normal.x;
      s.y[i] -= 2.0 * d * wall.normal.y;
      const Vec2 v = after_impact(wall, {s.vx[i], s.vy[i]});
      s.vx[i] = v.x;
      s.vy[i] = v.y;
    }
  }
}

// The rule in tiny steps is right to the first order in them: what two of them differ by is about
// what the finer one is off by, but a contact that falls now here, now there within a step may hide
// it. Ten times that and 1e-5 cm is allowed; what is wrong shows by 1e-2 cm and more.
TEST_P(PlainContact, TwoParticlesAndABondComeToWhereThePapersRuleTends) {
  for (const auto& [alpha, beta] :
       {std::pair{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}, {0.4, -1.0}, {1.0, -1.0}}) {
    for (const double tilt : {0.3, -1.2}) {
      SCOPED_TRACE(named("tilted", {tilt, 0.0}, alpha, beta));
      const Problem problem = two_particles(Wall{{0.0, 1.0}, 0.0, alpha, beta}, tilt);
      State coarse = problem.initial, fine = problem.initial;
      paper_steps(problem, 2e-6, std::llround(end / 2e-6), coarse);
      paper_steps(problem, 1e-6, std::llround(end / 1e-6), fine);
      const double off = largest_distance(coarse, fine);
      EXPECT_LT(off, 1e-3);  // else it would judge nothing
      const State found = solve(GetParam(), problem);
      EXPECT_LE(largest_distance(found, fine), 10.0 * off + 1e-5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, PlainContact, testing::ValuesIn(ways()),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace bounce
