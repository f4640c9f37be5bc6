// The equivalence check passes the kernels and catches kernels that are broken on purpose.
//
// A broken kernel here is a real one built from a corrupted problem (a class swapped, a bond
// dropped, a sign flipped, a sum turned round) and offered under the sound one's name: just what a
// slip in its source would make of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "kernels/plan/plan.hpp"
#include "verify/oracle/equivalence.hpp"
#include "verify/oracle/oracle.hpp"
#include "verify/oracle/wall_scenes.hpp"

namespace bounce {
namespace {

constexpr std::int64_t steps = 20000;

Scene example(double elasticity) {
  Scene scene;
  scene.law.elasticity = elasticity;
  scene.walls = {Wall{}};
  return scene;
}

std::vector<EquivalenceRow> check(const Scene& scene, const KernelUnderTest& kernel) {
  return check_equivalence("test", scene, steps, true, std::span(&kernel, 1));
}

bool all_pass(const std::vector<EquivalenceRow>& rows) {
  return !rows.empty() &&
         std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.pass; });
}

std::string print_failures(const std::vector<EquivalenceRow>& rows) {
  std::string text;
  for (const EquivalenceRow& row : rows) {
    if (!row.pass)
      text +=
          row.kernel + ", " + row.check + ": " + row.measured + ", allowed " + row.allowed + "\n";
  }
  return text;
}

using Corrupt = void (*)(Problem&);

KernelUnderTest kernel_with(const std::string& name, Corrupt corrupt) {
  PlanRequest request;
  request.kernel = name;
  request.threads = 1;
  return {name, name == "strict", [request, corrupt](const Problem& problem) {
            Problem changed = problem;
            corrupt(changed);
            return make_stepper(changed, request);
          }};
}

void swap_bond_class(Problem& problem) {
  BondList bonds = problem.bonds;
  for (std::uint16_t& c : bonds.bond_class) {
    if (c == 1) {
      c = 3;
    } else if (c == 3) {
      c = 1;
    }
  }
  problem.bonds = std::move(bonds);
}

// One entry of particle 57 taken out of its row (one direction of one bond).
void drop_bond(Problem& problem) {
  constexpr std::size_t particle = 56;
  BondList bonds = problem.bonds;
  bonds.neighbour.erase(bonds.neighbour.begin() + bonds.start[particle]);
  bonds.bond_class.erase(bonds.bond_class.begin() + bonds.start[particle]);
  for (std::size_t i = particle + 1; i < bonds.start.size(); ++i) --bonds.start[i];
  problem.bonds = std::move(bonds);
}

void flip_sign(Problem& problem) {
  problem.classes[4].attraction = -problem.classes[4].attraction;
  problem.classes[4].repulsion = -problem.classes[4].repulsion;
}

void turn_sums_round(Problem& problem) {
  BondList bonds = problem.bonds;
  for (std::size_t i = 0; i < bonds.particles(); ++i) {
    std::reverse(bonds.neighbour.begin() + bonds.start[i],
                 bonds.neighbour.begin() + bonds.start[i + 1]);
    std::reverse(bonds.bond_class.begin() + bonds.start[i],
                 bonds.bond_class.begin() + bonds.start[i + 1]);
  }
  problem.bonds = std::move(bonds);
}

void lose_the_wall(Problem& problem) { problem.walls.clear(); }

void round_a_constant(Problem& problem) {
  problem.classes[2].repulsion = std::nextafter(problem.classes[2].repulsion, 0.0);
}

void no_number(Problem& problem) {
  problem.initial.vx[200] = std::numeric_limits<double>::quiet_NaN();
}

struct Breakage {
  std::string name;
  std::string kernel;
  Corrupt corrupt;
};
void PrintTo(const Breakage& b, std::ostream* out) { *out << b.name; }

class BrokenKernel : public testing::TestWithParam<Breakage> {};

TEST_P(BrokenKernel, IsCaught) {
  const Scene scene = at_the_wall(example(16000.0));
  const auto rows = check(scene, kernel_with(GetParam().kernel, GetParam().corrupt));
  EXPECT_FALSE(all_pass(rows));
}

// `ring` has no row from which one bond could be dropped: it refuses such a list. The order of sums
// is its own in csr and ring, so turning it round is a fault of strict alone.
INSTANTIATE_TEST_SUITE_P(All, BrokenKernel,
                         testing::ValuesIn(std::vector<Breakage>{
                             {"strict_class", "strict", swap_bond_class},
                             {"csr_class", "csr", swap_bond_class},
                             {"ring_class", "ring", swap_bond_class},
                             {"strict_drop", "strict", drop_bond},
                             {"csr_drop", "csr", drop_bond},
                             {"strict_sign", "strict", flip_sign},
                             {"csr_sign", "csr", flip_sign},
                             {"ring_sign", "ring", flip_sign},
                             {"mirror_class", "mirror", swap_bond_class},
                             {"mirror_sign", "mirror", flip_sign},
                             {"mirror_wall", "mirror", lose_the_wall},
                             {"strict_sum", "strict", turn_sums_round},
                             {"strict_wall", "strict", lose_the_wall},
                             {"csr_wall", "csr", lose_the_wall},
                             {"ring_wall", "ring", lose_the_wall},
                             {"strict_constant", "strict", round_a_constant},
                             {"csr_nan", "csr", no_number},
                             {"ring_nan", "ring", no_number},
                         }),
                         [](const auto& param) { return param.param.name; });

TEST(Equivalence, HoldsForTheKernelsOfThisBuild) {
  const std::vector<KernelUnderTest> all = kernels_under_test();
  for (const double elasticity : {1000.0, 16000.0}) {
    for (const Scene& scene : {example(elasticity), at_the_wall(example(elasticity))}) {
      const auto rows = check_equivalence("test", scene, steps, true, all);
      EXPECT_TRUE(all_pass(rows)) << "E = " << elasticity << "\n" << print_failures(rows);
      std::set<std::string> names;
      for (const EquivalenceRow& row : rows) names.insert(row.kernel);
      EXPECT_EQ(names, (std::set<std::string>{"mirror", "ring", "annulus", "csr", "strict"}));
    }
  }
}

// Of all registered kernels those that have rows for the scene.
std::set<std::string> with_rows(const Scene& scene) {
  std::set<std::string> names;
  for (const EquivalenceRow& row :
       check_equivalence("scene", scene, 10, false, kernels_under_test())) {
    names.insert(row.kernel);
  }
  return names;
}

TEST(Equivalence, TakesEveryRegisteredKernelThatCanStepTheScene) {
  std::set<std::string> all;
  for (const KernelEntry& entry : kernels()) {
    // The oracle has the listing's contact alone.
    if (entry.contacts.front() == Contact::listing) all.insert(entry.name);
  }
  EXPECT_EQ(all, (std::set<std::string>{"mirror", "ring", "annulus", "csr", "strict"}));
  Scene scene = example(16000.0);
  EXPECT_EQ(with_rows(scene), all);
  scene.ball.velocity.x = 0.0001;  // not symmetric
  all.erase("mirror");
  EXPECT_EQ(with_rows(scene), all);
}

TEST(Equivalence, RingRefusesAListWithADroppedBond) {
  const Problem problem = make_problem(example(16000.0));
  EXPECT_THROW(kernel_with("ring", drop_bond).make(problem), PlanError);
}

TEST(Equivalence, SceneAtTheWallTouchesItSoon) {
  const Scene scene = at_the_wall(example(16000.0));
  Oracle oracle(scene, make_problem(scene).initial);
  oracle.step(steps);
  const State state = oracle.state();
  // A particle that has met the wall has lost its velocity; all the others fall at 0.7 cm/s.
  const bool met = std::any_of(state.vy.begin(), state.vy.end(), [](double v) { return v > -0.3; });
  EXPECT_TRUE(met);
}

// ---- the scenes of other walls

// Nearest distance of a particle to each wall, from the start to wall_scene_steps. A wall that is
// met is at most a step's way off, 3e-6 cm.
std::vector<double> nearest(const Scene& scene) {
  const Problem problem = make_problem(scene);
  std::vector<double> found(problem.walls.size(), 1.0);
  Oracle oracle(scene, problem.initial);
  for (std::int64_t step = 0; step <= wall_scene_steps; ++step) {
    if (step > 0) oracle.step(1);
    const Listing& ball = oracle.listing();
    for (std::size_t w = 0; w < found.size(); ++w) {
      for (int i = 1; i <= 360; ++i) {
        found[w] = std::min(found[w], wall_distance(problem.walls[w], ball.x[i], ball.y[i]));
      }
    }
  }
  return found;
}

TEST(WallScenes, MeetTheirWallsAndAreOfAllKinds) {
  std::set<std::string> names, kernels_seen;
  bool ceiling = false, upright = false, tilted = false, two = false, on = false, behind = false;
  for (const auto& [name, scene] : wall_scenes()) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_LE(name.size(), 23U) << name << ": the table's column";
    for (const double distance : nearest(scene)) EXPECT_LE(distance, 3e-6) << name;
    for (const std::string& kernel : with_rows(scene)) kernels_seen.insert(kernel);
    two = two || scene.walls.size() == 2;
    const Problem problem = make_problem(scene);
    for (const Wall& wall : problem.walls) {
      ceiling = ceiling || wall.normal.y == -1.0;
      upright = upright || wall.normal.y == 0.0;
      tilted = tilted || (wall.normal.x != 0.0 && wall.normal.y != 0.0);
      for (std::size_t i = 0; i < problem.initial.size(); ++i) {
        const double d = wall_distance(wall, problem.initial.x[i], problem.initial.y[i]);
        on = on || d == 0.0;
        behind = behind || d < 0.0;
      }
    }
  }
  EXPECT_TRUE(ceiling && upright && tilted && two && on && behind)
      << ceiling << upright << tilted << two << on << behind;
  EXPECT_EQ(kernels_seen, (std::set<std::string>{"mirror", "ring", "annulus", "csr", "strict"}));
}

TEST(WallScenes, HoldForTheKernelsOfThisBuild) {
  const std::vector<KernelUnderTest> all = kernels_under_test();
  for (const auto& [name, scene] : wall_scenes()) {
    const auto rows = check_equivalence(name, scene, wall_scene_steps, false, all);
    EXPECT_TRUE(all_pass(rows)) << name << "\n" << print_failures(rows);
  }
}

void take_ceilings_for_floors(Problem& problem) {
  for (Wall& wall : problem.walls) {
    if (wall.normal.x == 0.0) wall = {{0.0, 1.0}, std::abs(wall.offset), wall.alpha, wall.beta};
  }
}
void forget_the_second_wall(Problem& problem) { problem.walls.resize(1); }
void exchange_alpha_and_beta(Problem& problem) {
  for (Wall& wall : problem.walls) std::swap(wall.alpha, wall.beta);
}
void lose_alpha(Problem& problem) {
  for (Wall& wall : problem.walls) wall.alpha = 0.0;
}
void round_beta(Problem& problem) {
  for (Wall& wall : problem.walls) wall.beta = std::nextafter(wall.beta, -1.0);
}
void lean_over(Problem& problem) {
  for (Wall& wall : problem.walls) wall.normal.x = -wall.normal.x;
}
// Those that start behind a wall are put on the other side of it.
void let_in_what_is_behind(Problem& problem) {
  for (std::size_t i = 0; i < problem.initial.size(); ++i) {
    const Wall& wall = problem.walls.front();
    const double d = wall_distance(wall, problem.initial.x[i], problem.initial.y[i]);
    if (d < 0.0) problem.initial.y[i] -= 2.0 * d * wall.normal.y;
  }
}

class BrokenWalls : public testing::TestWithParam<Breakage> {};

TEST_P(BrokenWalls, AreCaughtByAWallScene) {
  const KernelUnderTest kernel = kernel_with(GetParam().kernel, GetParam().corrupt);
  for (const auto& [name, scene] : wall_scenes()) {
    if (GetParam().corrupt == forget_the_second_wall && scene.walls.size() < 2) continue;
    const auto rows =
        check_equivalence(name, scene, wall_scene_steps, false, std::span(&kernel, 1));
    if (!all_pass(rows)) return;
  }
  ADD_FAILURE() << "seen by no scene";
}

INSTANTIATE_TEST_SUITE_P(All, BrokenWalls,
                         testing::ValuesIn(std::vector<Breakage>{
                             {"csr_ceiling", "csr", take_ceilings_for_floors},
                             {"ring_ceiling", "ring", take_ceilings_for_floors},
                             {"ring_second", "ring", forget_the_second_wall},
                             {"annulus_exchanged", "annulus", exchange_alpha_and_beta},
                             {"ring_alpha", "ring", lose_alpha},
                             {"strict_beta", "strict", round_beta},
                             {"csr_leaning", "csr", lean_over},
                             {"ring_behind", "ring", let_in_what_is_behind},
                         }),
                         [](const auto& param) { return param.param.name; });

TEST(Equivalence, UlpsBetween) {
  EXPECT_EQ(ulps_between(1.0, 1.0), 0.0);
  EXPECT_EQ(ulps_between(3.0, std::nextafter(3.0, 4.0)), 1.0);
  EXPECT_EQ(ulps_between(0.0, std::numeric_limits<double>::quiet_NaN()),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace bounce
