// What leaving out saves: pairs of plans for nearly the same scene, one of which has code that the
// other does without, on Example 2 far from its wall.
//
// Each repetition takes turns of 200 steps of the one and 200 of the other, so that a clock that
// swings hits both; the gain is the median of their ratios. A pair of the same plan twice says what
// cannot be told from nothing.
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/run_rows.hpp"
#include "bench/timing.hpp"
#include "driver/scene/scene_file.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

constexpr int turns = 401;
constexpr std::int64_t steps_a_turn = 200;

using Change = std::function<void(Scene&)>;

struct Side {
  std::string kernel;
  Change change;
  std::string scene = "example-2";
};

std::unique_ptr<Stepper> stepper_of(const Side& side) {
  Scene scene = SceneFile::find(side.scene).scene();
  side.change(scene);
  const Problem problem = make_problem(scene);
  return make_stepper(problem, {side.kernel, "auto", 1});
}

// `with` has what `without` leaves out.
void add_pair(const std::string& name, const Side& with, const Side& without) {
  const auto run = [with, without](benchmark::State& state) {
    const auto a = stepper_of(with);
    const auto b = stepper_of(without);
    const std::int64_t steps = with.scene == "annulus" ? 1 : steps_a_turn;
    std::vector<double> ratios;
    for (auto turn : state) {
      (void)turn;
      const double with_it = seconds_of(*a, steps);
      const double without_it = seconds_of(*b, steps);
      ratios.push_back(with_it / without_it);
      state.SetIterationTime(with_it + without_it);
    }
    state.counters["gain"] = median(ratios);
  };
  benchmark::RegisterBenchmark(name.c_str(), run)->UseManualTime()->Iterations(turns);
}

void as_it_is(Scene&) {}
void no_wall(Scene& scene) { scene.walls.clear(); }
void no_gravity(Scene& scene) { scene.gravity = {}; }
// The floor as a wall that might have any direction: its normal is off by less than a bit of y.
void any_direction(Scene& scene) { scene.walls.front().normal.x = 1e-17; }
void two_walls(Scene& scene) { scene.walls.push_back({{0.0, -1.0}, -1000.0, 0.0, 0.0}); }
void floor_and_slope(Scene& scene) { scene.walls.push_back({{0.6, 0.8}, -1000.0, 0.0, 0.0}); }
void slippery(Scene& scene) {
  scene.walls.front().alpha = 1.0;
  scene.walls.front().beta = -1.0;
}

// The ball's lowest particles on the floor, pressed by its weight.
void resting(Scene& scene) { scene.ball.centre.y = 7.0; }
void resting_resolved(Scene& scene) {
  resting(scene);
  scene.walls.front().contact = Contact::resolved;
}
void resolved(Scene& scene) { scene.walls.front().contact = Contact::resolved; }

void nothing(Scene& scene) {
  no_wall(scene);
  no_gravity(scene);
}

Change law(double p, double q) {
  return [p, q](Scene& scene) {
    scene.law.p = p;
    scene.law.q = q;
    scene.law.rest = Rest::geometry;
  };
}

void add_pairs() {
  const Side ring{"ring", as_it_is}, csr{"csr", as_it_is};
  add_pair("nothing (ring against itself)", ring, ring);
  add_pair("the wall test, in ring", ring, {"ring", no_wall});
  add_pair("the wall test, in mirror", {"mirror", as_it_is}, {"mirror", no_wall});
  add_pair("the wall test, in csr", csr, {"csr", no_wall});
  for (const char* kernel : {"ring", "mirror", "csr"}) {
    const std::string in = std::string(", in ") + kernel;
    add_pair("the test at two walls" + in, {kernel, two_walls}, {kernel, no_wall});
  }
  add_pair("the test at a tilted wall, in ring", {"ring", any_direction}, {"ring", no_wall});
  add_pair("the test at a floor and a tilted wall, in ring", {"ring", floor_and_slope},
           {"ring", no_wall});
  add_pair("friction and restitution of the wall, in ring", {"ring", slippery}, ring);
  for (const char* kernel : {"ring", "mirror", "csr"}) {
    const std::string in = std::string(", in ") + kernel;
    add_pair("resolved contact for the listing's, in the air" + in, {kernel, resolved},
             {kernel, as_it_is});
    add_pair("resolved contact for the listing's, on the floor" + in, {kernel, resting_resolved},
             {kernel, resting});
  }
  add_pair("gravity, in ring", ring, {"ring", no_gravity});
  add_pair("a square root: exponents (2, 4) for (3, 5), in ring", {"ring", law(2, 4)}, ring);
  add_pair("higher powers: (7, 13) for (3, 5), in ring", {"ring", law(7, 13)}, ring);
  add_pair("variable exponents: odd (3, 7) for (3, 5), in csr", {"csr", law(3, 7)}, csr);
  add_pair("pow: (2.5, 4.5) for (3, 5), in csr", {"csr", law(2.5, 4.5)}, csr);
  add_pair("neighbour index, gathers, each bond twice: csr for ring", csr, ring);
  add_pair("the same on an annulus of 72,000 particles: csr for annulus",
           {"csr", as_it_is, "annulus"}, {"annulus", as_it_is, "annulus"});
  add_pair("the other half of the ball: ring for mirror", ring, {"mirror", as_it_is});
  const auto with = [](const Change& exponents) {
    return [exponents](Scene& scene) {
      exponents(scene);
      any_direction(scene);
      two_walls(scene);
    };
  };
  add_pair("together, in ring: (7, 13), two walls in any direction, gravity for (3, 5) alone",
           {"ring", with(law(7, 13))}, {"ring", nothing});
  add_pair("together, csr for mirror: the same with variable exponents (3, 7)",
           {"csr", with(law(3, 7))}, {"mirror", nothing});
  const Change all = [](Scene& scene) {
    law(2.5, 4.5)(scene);
    any_direction(scene);
  };
  add_pair("all of it: csr, pow, any wall for mirror without a wall", {"csr", all},
           {"mirror", no_wall});
}

}  // namespace
}  // namespace bounce

int main(int argc, char** argv) { return bounce::run_rows(argc, argv, bounce::add_pairs); }
