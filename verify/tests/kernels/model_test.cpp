// What is simulated: ball, bonds, pair law, constants, scene limits.
#include <gsl/gsl_deriv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "kernels/model/ball.hpp"
#include "kernels/model/bonds.hpp"
#include "kernels/model/neighbours.hpp"
#include "kernels/model/pair_law.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/model/powers.hpp"
#include "verify/tests/paper_scenes.hpp"

namespace bounce {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- bonds ----

// Neighbours of particle i (from 1) in the listing's order: MODEL 3, row by row.
std::vector<int> listing_row(int i) {
  if (i == 1) return {2, 120, 121, 240};
  if (i <= 119) return {i + 1, i - 1, i + 120, i + 119};
  if (i == 120) return {1, 119, 240, 239};
  if (i == 121) return {1, 2, 122, 240, 242, 241};
  if (i <= 239) return {i - 120, i - 119, i + 1, i - 1, i + 120, i + 121};
  if (i == 240) return {120, 1, 121, 239, 360, 241};
  if (i == 241) return {242, 360, 121, 240};
  if (i <= 359) return {i + 1, i - 1, i - 120, i - 121};
  return {359, 241, 240, 239};
}

int ring_of(int i) { return (i - 1) / 120; }

std::vector<int> row_of(const BondList& bonds, int i) {
  const auto row = static_cast<std::size_t>(i - 1);
  std::vector<int> found;
  for (auto e = bonds.start[row]; e < bonds.start[row + 1]; ++e) {
    found.push_back(bonds.neighbour[static_cast<std::size_t>(e)] + 1);
  }
  return found;
}

TEST(Bonds, PapersBallInTheListingsOrder) {
  const BondList bonds = ring_bonds(3, 120);
  ASSERT_EQ(bonds.particles(), 360U);
  EXPECT_EQ(bonds.bonds(), 840U);
  EXPECT_EQ(bonds.entries(), 1680U);
  for (int i = 1; i <= 360; ++i) EXPECT_EQ(row_of(bonds, i), listing_row(i)) << "particle " << i;
}

TEST(Bonds, ClassIsTheSumOfTheRings) {
  const BondList bonds = ring_bonds(3, 120);
  for (int i = 1; i <= 360; ++i) {
    auto e = static_cast<std::size_t>(bonds.start[static_cast<std::size_t>(i - 1)]);
    for (const int j : listing_row(i)) {
      EXPECT_EQ(static_cast<int>(bonds.bond_class[e++]), ring_of(i) + ring_of(j)) << i << "-" << j;
    }
  }
}

TEST(Bonds, SymmetricForAnyRings) {
  for (const int rings : {1, 2, 3, 4, 7}) {
    for (const std::int64_t per_ring : {3, 4, 5, 120}) {
      const BondList bonds = ring_bonds(rings, per_ring);
      EXPECT_NO_THROW(check_bonds(bonds)) << rings << " x " << per_ring;
      const auto n = static_cast<std::size_t>(per_ring);
      const auto r = static_cast<std::size_t>(rings);
      EXPECT_EQ(bonds.bonds(), r * n + 2 * (r - 1) * n);
    }
  }
}

// Rows that are computed are the rows of the list; the list is built once, for all copies.
TEST(Neighbours, OfRingsAreTheListWithoutIt) {
  for (const int rings : {1, 2, 3, 4, 7}) {
    for (const std::int64_t per_ring : {3, 4, 120}) {
      const Neighbours computed = Neighbours::of_rings(rings, per_ring);
      const Neighbours listed = ring_bonds(rings, per_ring);
      EXPECT_FALSE(listed.rings());
      ASSERT_EQ(computed.particles(), listed.particles());
      EXPECT_EQ(computed.entries(), listed.entries());
      EXPECT_EQ(computed.bonds(), listed.bonds());
      for (std::size_t i = 0; i < listed.particles(); ++i) {
        EXPECT_EQ(computed.row_length(i), listed.row_length(i)) << i;
        const BondList& list = listed;
        auto e = static_cast<std::size_t>(list.start[i]);
        computed.visit_row(i, [&](std::size_t neighbour, std::size_t bond_class) {
          EXPECT_EQ(neighbour, static_cast<std::size_t>(list.neighbour[e])) << i;
          EXPECT_EQ(bond_class, list.bond_class[e++]) << i;
        });
      }
      EXPECT_EQ(computed, listed);
      const Neighbours copy = computed;
      EXPECT_EQ(&copy.list(), &computed.list());
    }
  }
  EXPECT_FALSE(Neighbours::of_rings(3, 120) == Neighbours::of_rings(3, 121));
  EXPECT_FALSE(Neighbours::of_rings(3, 120) == Neighbours(ring_bonds(3, 121)));
  EXPECT_EQ(Neighbours().particles(), 0U);
}

// Of balls that keep their bonds and of one that does not.
TEST(Neighbours, EachBondIsVisitedOnceRowByRow) {
  using Bonds = std::vector<std::array<std::size_t, 3>>;
  for (const std::int64_t per_ring : {4, 120, 7000}) {
    for (const Neighbours& neighbours :
         {Neighbours::of_rings(3, per_ring), Neighbours(ring_bonds(3, per_ring))}) {
      Bonds expected, found;
      for (std::size_t i = 0; i < neighbours.particles(); ++i) {
        neighbours.visit_row(i, [&](std::size_t j, std::size_t bond_class) {
          if (j > i) expected.push_back({i, j, bond_class});
        });
      }
      neighbours.for_each_bond([&](std::size_t i, std::size_t j, std::size_t bond_class) {
        found.push_back({i, j, bond_class});
      });
      EXPECT_EQ(found.size(), neighbours.bonds());
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(Neighbours, AnyThreadMayAskForTheList) {
  const Neighbours neighbours = Neighbours::of_rings(3, 5000);
  std::vector<const BondList*> seen(4);
#pragma omp parallel for num_threads(4)
  for (std::size_t t = 0; t < 4; ++t) seen[t] = &neighbours.list();
  for (const BondList* list : seen) {
    EXPECT_EQ(list, seen.front());
    EXPECT_EQ(list->particles(), 15000U);
  }
}

// Bonds of the list are the shortest distances there are: nothing else lies as near.
TEST(Bonds, JoinNearestParticles) {
  const Problem problem = make_problem(paper_scene(2));
  for (const BondClass& bond_class : problem.classes) EXPECT_GT(bond_class.rest, 0.26);
  for (int i = 1; i <= 360; ++i) {
    const auto a = static_cast<std::size_t>(i - 1);
    for (const int j : listing_row(i)) {
      const auto b = static_cast<std::size_t>(j - 1);
      const double d = std::hypot(problem.initial.x[a] - problem.initial.x[b],
                                  problem.initial.y[a] - problem.initial.y[b]);
      const auto c = static_cast<std::size_t>(ring_of(i)) + static_cast<std::size_t>(ring_of(j));
      EXPECT_NEAR(d, problem.classes[c].rest, 2e-4) << i << "-" << j;  // four decimals at both ends
    }
  }
}

TEST(Bonds, CheckCatchesEachCorruption) {
  const BondList good = ring_bonds(3, 120);
  EXPECT_NO_THROW(check_bonds(good));
  const std::vector<std::function<void(BondList&)>> corruptions{
      [](BondList& b) { b.neighbour[17] = 360; },                // out of range
      [](BondList& b) { b.neighbour[17] = -1; },                 //
      [](BondList& b) { b.neighbour[20] = 5; },                  // itself
      [](BondList& b) { b.neighbour[1] = b.neighbour[0]; },      // twice
      [](BondList& b) { b.neighbour[2] = 200; },                 // no way back
      [](BondList& b) { b.bond_class[9] = 4; },                  // another class there
      [](BondList& b) { b.start[10] += 1; },                     // a row too long
      [](BondList& b) { std::swap(b.start[10], b.start[11]); },  // not increasing
      [](BondList& b) { b.start.back() -= 1; },                  // entries left over
      [](BondList& b) { b.start.front() = 1; },                  //
      [](BondList& b) { b.start.clear(); },                      //
      [](BondList& b) { b.bond_class.pop_back(); },              //
  };
  for (std::size_t k = 0; k < corruptions.size(); ++k) {
    BondList bad = good;
    corruptions[k](bad);
    EXPECT_THROW(check_bonds(bad), std::logic_error) << "corruption " << k;
  }
}

// ---- disc ----

Scene disc_scene(double radius, double spacing) {
  Scene scene = paper_scene(2);
  scene.ball.kind = BallKind::disc;
  scene.ball.radii = {radius};
  scene.ball.spacing = spacing;
  scene.ball.rounding = Rounding::none;
  scene.law.rest = Rest::geometry;
  return scene;
}

// Lattice points within 1, sqrt(3), 2, sqrt(7), 3 spacings of one of them, counted by hand; bonds
// of a full hexagon of side n: 9 n^2 + 3 n.
TEST(Disc, HoldsTheLatticePointsWithinItsRadius) {
  struct Count {
    double radius;
    std::size_t particles;
  };
  for (const Count& c : {Count{1.0, 7},
                         {1.7, 7},
                         {std::sqrt(3.0), 13},
                         {2.0, 19},
                         {2.6, 19},
                         {std::sqrt(7.0), 31},
                         {3.0, 37}}) {
    const double spacing = 0.3;
    const Problem p = make_problem(disc_scene(c.radius * spacing, spacing));
    EXPECT_EQ(p.initial.size(), c.particles) << c.radius;
    EXPECT_EQ(ball_size(disc_scene(c.radius, 1.0).ball).particles, c.particles) << c.radius;
  }
  EXPECT_EQ(make_problem(disc_scene(1.0, 1.0)).bonds.bonds(), 12U);
  EXPECT_EQ(make_problem(disc_scene(2.0, 1.0)).bonds.bonds(), 42U);
}

// By brute force: bound are those a spacing apart, and no others stand nearer than sqrt(3) of it.
TEST(Disc, BindsWhoStandsASpacingApart) {
  const Scene scene = disc_scene(2.3, 0.31);
  const Problem p = make_problem(scene);
  const State& s = p.initial;
  EXPECT_NO_THROW(check_bonds(p.bonds));
  std::size_t bonds = 0;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_LE(std::hypot(s.x[i], s.y[i] - 10.0), 2.3 * (1.0 + 1e-12));
    if (p.bonds.row_length(i) == 6) ++inside;
    EXPECT_GE(p.bonds.row_length(i), 2U);
    std::vector<std::size_t> near;
    for (std::size_t j = 0; j < s.size(); ++j) {
      const double d = std::hypot(s.x[i] - s.x[j], s.y[i] - s.y[j]) / 0.31;
      if (j != i && d < 1.5) {
        EXPECT_NEAR(d, 1.0, 1e-13);
        near.push_back(j);
      }
    }
    std::vector<std::size_t> row;
    p.bonds.visit_row(i, [&row](std::size_t j, std::size_t c) {
      EXPECT_EQ(c, 0U);
      row.push_back(j);
    });
    std::sort(row.begin(), row.end());
    EXPECT_EQ(row, near) << i;
    bonds += near.size();
  }
  EXPECT_EQ(p.bonds.entries(), bonds);
  EXPECT_GT(inside, s.size() / 2);
  EXPECT_EQ(ball_size(scene.ball).entries, bonds);
  EXPECT_EQ(ball_size(scene.ball).list_bytes, 8 * (s.size() + 1) + 6 * bonds);
  ASSERT_EQ(p.classes.size(), 1U);
  EXPECT_NEAR(p.classes[0].rest, 0.31, 1e-15);
}

TEST(Disc, IsSymmetricAndRoundedOnDemand) {
  Scene scene = disc_scene(2.0, 0.25);
  const State exact = make_ball(scene.ball);
  double sum_x = 0.0, sum_y = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    sum_x += exact.x[i];
    sum_y += exact.y[i] - 10.0;
  }
  EXPECT_NEAR(sum_x, 0.0, 1e-12);
  EXPECT_NEAR(sum_y, 0.0, 1e-11);
  scene.ball.rounding = Rounding::listing;
  const State rounded = make_ball(scene.ball);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_EQ(rounded.x[i], four_decimals(exact.x[i]));
    EXPECT_EQ(rounded.y[i], four_decimals(exact.y[i]));
  }
}

// ---- pair law ----

struct LawAt {
  PairLaw law;
  BondClass bond;
};

double potential_at(double r, void* at) {
  const auto* law_at = static_cast<const LawAt*>(at);
  return potential(law_at->law, law_at->bond, r * r);
}

class PairLawTest : public testing::TestWithParam<PairLaw> {
 protected:
  static BondClass bond(PairLaw law) {
    const double rest = 0.26;
    return {16000.0, 16000.0 * std::pow(rest, law.q - law.p), rest};
  }
};

TEST_P(PairLawTest, ForceIsMinusTheGradient) {
  LawAt at{GetParam(), bond(GetParam())};
  const gsl_function function{&potential_at, &at};
  for (const double r : {0.13, 0.2, 0.26, 0.3, 0.5, 1.0, 3.0}) {
    double slope = 0.0;
    double error = 0.0;
    ASSERT_EQ(gsl_deriv_central(&function, r, 1e-4 * r, &slope, &error), 0);
    const double force = force_over_distance(at.law, at.bond, r * r) * r;
    // At rest the two terms cancel, so the scale is one of them, not the force.
    const double scale = at.bond.attraction / std::pow(r, at.law.p);
    EXPECT_NEAR(force, -slope, 1e-8 * scale + 2.0 * error) << "R = " << r;
    EXPECT_LE(error, 1e-6 * scale + 1e-6 * std::abs(force)) << "the slope is too rough to judge by";
  }
}

TEST_P(PairLawTest, RestIsRestAndTheLawIsThePapers) {
  const PairLaw law = GetParam();
  const BondClass b = bond(law);
  const double scale = b.attraction / std::pow(b.rest, law.p);
  EXPECT_NEAR(force_over_distance(law, b, b.rest * b.rest) * b.rest, 0.0, 1e-13 * scale);
  for (const double r : {0.1, 0.2, 0.4, 2.0}) {
    const double expected =
        -b.attraction / std::pow(r, law.p) + b.repulsion / std::pow(r, law.q);  // equation 1
    EXPECT_NEAR(force_over_distance(law, b, r * r) * r, expected,
                1e-12 * (b.attraction / std::pow(r, law.p) + b.repulsion / std::pow(r, law.q)));
  }
  EXPECT_GT(force_over_distance(law, b, 0.04), 0.0);  // repulsion when pressed
  EXPECT_LT(force_over_distance(law, b, 0.09), 0.0);
}

double force_at(double r, void* at) {
  const auto* law_at = static_cast<const LawAt*>(at);
  return force_over_distance(law_at->law, law_at->bond, r * r) * r;
}

TEST_P(PairLawTest, StiffnessIsMinusTheSlopeOfTheForce) {
  LawAt at{GetParam(), bond(GetParam())};
  const gsl_function function{&force_at, &at};
  for (const double r : {0.13, 0.2, 0.26, 0.3, 0.5, 1.0, 3.0}) {
    double slope = 0.0;
    double error = 0.0;
    ASSERT_EQ(gsl_deriv_central(&function, r, 1e-4 * r, &slope, &error), 0);
    const Stiffness found = stiffness(at.law, at.bond, r * r);
    const double scale = at.bond.attraction / std::pow(r, at.law.p + 1.0);
    EXPECT_NEAR(found.along, -slope, 1e-8 * scale + 2.0 * error) << "R = " << r;
    EXPECT_LE(error, 1e-6 * scale + 1e-6 * std::abs(slope)) << "the slope is too rough to judge by";
    EXPECT_EQ(found.across, -force_over_distance(at.law, at.bond, r * r)) << "R = " << r;
  }
  const double rest = at.bond.rest;  // there V'' = (q - p) G / R0^(p+1)
  const double expected =
      (at.law.q - at.law.p) * at.bond.attraction / std::pow(rest, at.law.p + 1.0);
  EXPECT_NEAR(stiffness(at.law, at.bond, rest * rest).along, expected, 1e-12 * expected);
}

INSTANTIATE_TEST_SUITE_P(Exponents, PairLawTest,
                         testing::Values(PairLaw{3, 5}, PairLaw{7, 13}, PairLaw{2, 4},
                                         PairLaw{1, 3}, PairLaw{2.5, 4.5}, PairLaw{0.5, 1},
                                         PairLaw{3, 6}));

// Sums over bonds take the powers of a law once a sum: even, odd and broken ones, and the
// logarithm.
TEST(PairLaw, PowersTakenOnceAreThoseOfEachBond) {
  const BondClass bond{3.0, 2.0, 0.25};
  for (const PairLaw law : {PairLaw{3, 5}, PairLaw{7, 13}, PairLaw{2, 4}, PairLaw{3, 7},
                            PairLaw{2.5, 4.5}, PairLaw{1, 2}}) {
    const StiffnessOf stiffness_of(law);
    const PotentialOf potential_of(law);
    for (const double r : {0.1, 0.25, 0.26, 1.0, 7.0}) {
      const double r2 = r * r;
      const Stiffness once = stiffness_of(bond, r2), each = stiffness(law, bond, r2);
      // Of the two terms, which nearly cancel at rest: some ten roundings.
      const double size = 1e-14 * (law.q * bond.repulsion * std::pow(r, -law.q - 1.0) +
                                   law.p * bond.attraction * std::pow(r, -law.p - 1.0));
      EXPECT_NEAR(once.along, each.along, size) << law.p << ' ' << law.q << ' ' << r;
      EXPECT_NEAR(once.across, each.across, size) << law.p << ' ' << law.q << ' ' << r;
      EXPECT_NEAR(potential_of(bond, r2), potential(law, bond, r2), size * (r2 + 1.0))
          << law.p << ' ' << law.q << ' ' << r;
    }
  }
}

TEST(PairLaw, PotentialOfThePapersLaw) {
  const BondClass bond{16000.0, 1096.64, std::sqrt(0.06854)};
  const double u = 1.0 / 0.09;
  // MODEL 2: E (-u/2 + R0^2 u^2/4).
  EXPECT_NEAR(potential({3, 5}, bond, 0.09), -8000.0 * u + 274.16 * u * u, 1e-10);
}

// ---- constants and start ----

TEST(Problem, SingleLiterals) {
  EXPECT_EQ(single_literal(1096.64), 1096.6400146484375);  // MODEL 3
  EXPECT_EQ(single_literal(0.098), 0.09799999743700027);
  EXPECT_EQ(single_literal(0.000001), 9.999999974752427e-07);
  EXPECT_EQ(single_literal(16000.0), 16000.0);
}

// Both components at once: GCC 12.2 drops the rounding of a pair unless it is kept from it.
TEST(Problem, GravityAndStepAreRounded) {
  Scene scene = paper_scene(2);
  scene.gravity = {0.1, -0.098};
  const Problem rounded = make_problem(scene);
  EXPECT_EQ(rounded.gravity.x, static_cast<double>(0.1F));
  EXPECT_EQ(rounded.gravity.y, -0.09799999743700027);
  EXPECT_EQ(rounded.step, 9.999999974752427e-07);
  scene.constants = Constants::double_precision;
  EXPECT_EQ(make_problem(scene).gravity.y, -0.098);
  EXPECT_EQ(make_problem(scene).step, 1e-6);
}

TEST(Problem, ClassesOfThePapersBall) {
  const Problem problem = make_problem(paper_scene(2));
  const std::array<float, 5> repulsion{1096.64F, 16328.0F, 1578.4F, 16462.8F, 2148.8F};
  const std::array<double, 5> rest_squared{0.06854, 1.0205, 0.09865, 1.028925, 0.1343};
  ASSERT_EQ(problem.classes.size(), 5U);
  for (std::size_t c = 0; c < 5; ++c) {
    EXPECT_EQ(problem.classes[c].attraction, 16000.0);
    EXPECT_EQ(problem.classes[c].repulsion, static_cast<double>(repulsion[c]));
    EXPECT_NEAR(problem.classes[c].rest, std::sqrt(rest_squared[c]), 1e-15);
  }
}

TEST(Problem, RestFromGeometry) {
  Scene scene = paper_scene(2);
  scene.law.rest = Rest::geometry;
  scene.constants = Constants::double_precision;
  const Problem problem = make_problem(scene);
  const double s = std::sin(std::numbers::pi / 120.0);
  const double c = std::cos(std::numbers::pi / 120.0);
  const std::array<double, 5> rest_squared{100 * s * s, 61 - 60 * c, 144 * s * s, 85 - 84 * c,
                                           196 * s * s};  // MODEL 2
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(problem.classes[k].rest, std::sqrt(rest_squared[k]), 1e-13);
    EXPECT_NEAR(problem.classes[k].repulsion, 16000.0 * rest_squared[k], 1e-9);
  }
}

TEST(Problem, GeometryIsTheDistanceOfTheExactBall) {
  Scene scene = paper_scene(2);
  scene.law.rest = Rest::geometry;
  scene.ball.rounding = Rounding::none;
  scene.ball.radii = {10.0, 11.0, 12.0, 14.5};
  scene.ball.per_ring = 50;
  scene.ball.centre.y = 20.0;
  const Problem p = make_problem(scene);
  const BondList& bonds = p.bonds;
  for (std::size_t i = 0; i < bonds.particles(); ++i) {
    for (auto e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto j = static_cast<std::size_t>(bonds.neighbour[static_cast<std::size_t>(e)]);
      const double d = std::hypot(p.initial.x[i] - p.initial.x[j], p.initial.y[i] - p.initial.y[j]);
      EXPECT_NEAR(d, p.classes[bonds.bond_class[static_cast<std::size_t>(e)]].rest, 1e-13);
    }
  }
}

TEST(Problem, StartHasFourDecimals) {
  const State start = make_problem(paper_scene(5)).initial;
  ASSERT_EQ(start.size(), 360U);
  for (std::size_t i = 0; i < 360; ++i) {
    for (const double v : {start.x[i], start.y[i], start.vx[i], start.vy[i]}) {
      // The double nearest to a number of four decimals.
      EXPECT_TRUE(same_bits(v, std::round(v * 1e4) / 1e4)) << "particle " << i + 1;
    }
    EXPECT_EQ(start.vx[i], 4.0);
  }
  EXPECT_EQ(start.x[0], 5.0);
  EXPECT_EQ(start.y[0], 10.0);
  EXPECT_EQ(start.x[1], 4.9931);  // 5 cos 3 deg = 4.993148
  EXPECT_EQ(start.y[1], 10.2617);
  EXPECT_EQ(start.x[120], 5.9979);  // 6 cos 1.5 deg = 5.997944
}

TEST(Problem, StartIsMirrorSymmetric) {
  const State s = make_problem(paper_scene(2)).initial;
  for (int ring = 0; ring < 3; ++ring) {
    for (int column = 0; column < 120; ++column) {
      const int mirrored = ring == 1 ? (59 - column + 120) % 120 : (60 - column + 120) % 120;
      const auto i = std::size_t{120} * ring + column;
      const auto j = std::size_t{120} * ring + mirrored;
      EXPECT_TRUE(same_bits(s.x[i], 0.0 - s.x[j])) << "particles " << i + 1 << ", " << j + 1;
      EXPECT_TRUE(same_bits(s.y[i], s.y[j])) << "particles " << i + 1 << ", " << j + 1;
    }
  }
}

TEST(Problem, TakesAnotherStart) {
  const Scene scene = paper_scene(2);
  State start = make_problem(scene).initial;
  start.vx[3] = 1.5;
  EXPECT_EQ(make_problem(scene, start).initial.vx[3], 1.5);
  EXPECT_THROW(make_problem(scene, State(359)), SceneError);
  start.y[100] = -1.0;
  EXPECT_THROW(make_problem(scene, start), SceneError);
  start.y[100] = nan;
  EXPECT_THROW(make_problem(scene, start), SceneError);
}

TEST(Problem, RefusesABallBehindAWall) {
  Scene scene = paper_scene(2);
  scene.ball.centre.y = 6.9;
  try {
    make_problem(scene);
    FAIL() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.key, "wall[0]");
    EXPECT_NE(std::string(error.what()).find("behind"), std::string::npos) << error.what();
  }
  scene.ball.centre.y = 7.0;  // touches
  EXPECT_NO_THROW(make_problem(scene));
}

TEST(State, HashSeesEveryBit) {
  const State state = make_problem(paper_scene(2)).initial;
  for (auto member : {&State::x, &State::y, &State::vx, &State::vy}) {
    State other = state;
    (other.*member)[359] = std::nextafter((other.*member)[359], 100.0);
    EXPECT_NE(state_hash(other), state_hash(state));
  }
  State negative = state;
  negative.vx[0] = -0.0;
  EXPECT_NE(state_hash(negative), state_hash(state));
  EXPECT_EQ(state_hash(State(state)), state_hash(state));
}

// ---- scene limits ----

TEST(Scene, StepsAreCountedInTheNominalStep) {
  const Scene scene = paper_scene(2);
  EXPECT_EQ(scene.steps_until(15.0), 15000000);
  EXPECT_EQ(scene.steps_until(0.01), 10000);
}

TEST(Scene, AcceptsTheExamples) {
  for (int example = 1; example <= 7; ++example) {
    EXPECT_NO_THROW(make_problem(paper_scene(example))) << example;
  }
}

struct BadValue {
  std::string key;
  std::function<void(Scene&)> spoil;
};
void PrintTo(const BadValue& bad, std::ostream* out) { *out << bad.key; }

class SceneLimits : public testing::TestWithParam<BadValue> {};

TEST_P(SceneLimits, NamesTheKeyAndWhatIsAllowed) {
  Scene scene = paper_scene(2);
  GetParam().spoil(scene);
  try {
    validate(scene);
    FAIL() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.key, GetParam().key);
    EXPECT_FALSE(error.value.empty());
    EXPECT_FALSE(error.allowed.empty());
    EXPECT_NE(std::string(error.what()).find(error.allowed), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Ball, SceneLimits,
    testing::Values(BadValue{"ball.radii", [](Scene& s) { s.ball.radii.clear(); }},
                    BadValue{"ball.radii", [](Scene& s) { s.ball.radii.resize(1000000); }},
                    BadValue{"ball.radii[0]", [](Scene& s) { s.ball.radii[0] = -5.0; }},
                    BadValue{"ball.radii[0]", [](Scene& s) { s.ball.radii[0] = 0.0; }},
                    BadValue{"ball.radii[1]", [](Scene& s) { s.ball.radii[1] = nan; }},
                    BadValue{"ball.radii[1]", [](Scene& s) { s.ball.radii[1] = 5.0; }},
                    BadValue{"ball.radii[2]", [](Scene& s) { s.ball.radii[2] = infinity; }},
                    BadValue{"ball.per_ring", [](Scene& s) { s.ball.per_ring = 1000000000000; }},
                    BadValue{"ball.per_ring", [](Scene& s) { s.ball.per_ring = 2; }},
                    BadValue{"ball.per_ring", [](Scene& s) { s.ball.per_ring = -120; }},
                    BadValue{"ball.spacing", [](Scene& s) { s.ball.spacing = 0.1; }},
                    BadValue{"ball.radii", [](Scene& s) { s.ball.kind = BallKind::disc; }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, 2.1); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, -0.1); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, 0.0); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, nan); }},
                    BadValue{"ball.spacing", [](Scene& s) { s = disc_scene(2.0, 1e-5); }},
                    BadValue{"ball.spacing",
                             [](Scene& s) {
                               s = disc_scene(2.0, 0.1);
                               s.ball.spacing.reset();
                             }},
                    BadValue{"law.rest",
                             [](Scene& s) {
                               s = disc_scene(2.0, 0.1);
                               s.law.rest = Rest::listing;
                             }},
                    BadValue{"ball.centre", [](Scene& s) { s.ball.centre.x = nan; }},
                    BadValue{"ball.velocity", [](Scene& s) { s.ball.velocity.y = infinity; }}));

INSTANTIATE_TEST_SUITE_P(
    Law, SceneLimits,
    testing::Values(BadValue{"law.p", [](Scene& s) { s.law.p = 0.0; }},
                    BadValue{"law.p", [](Scene& s) { s.law.p = nan; }},
                    BadValue{"law.q", [](Scene& s) { s.law.q = 3.0; }},
                    BadValue{"law.q", [](Scene& s) { s.law.q = infinity; }},
                    BadValue{"law.q", [](Scene& s) { s.law.q = nan; }},
                    BadValue{"law.elasticity", [](Scene& s) { s.law.elasticity = 0.0; }},
                    BadValue{"law.elasticity", [](Scene& s) { s.law.elasticity = nan; }},
                    BadValue{"law.rest", [](Scene& s) { s.ball.radii[2] = 8.0; }},
                    BadValue{"gravity.acceleration", [](Scene& s) { s.gravity.y = nan; }}));

INSTANTIATE_TEST_SUITE_P(
    Wall, SceneLimits,
    testing::Values(BadValue{"wall[0].normal",
                             [](Scene& s) {
                               s.walls[0].normal = {1.0, 1.0};
                             }},
                    BadValue{"wall[0].normal",
                             [](Scene& s) {
                               s.walls[0].normal = {0.0, 0.0};
                             }},
                    BadValue{"wall[0].normal", [](Scene& s) { s.walls[0].normal.y = nan; }},
                    BadValue{"wall[0].offset", [](Scene& s) { s.walls[0].offset = infinity; }},
                    BadValue{"wall[0].alpha", [](Scene& s) { s.walls[0].alpha = 1.5; }},
                    BadValue{"wall[0].alpha", [](Scene& s) { s.walls[0].alpha = -0.1; }},
                    BadValue{"wall[0].alpha", [](Scene& s) { s.walls[0].alpha = nan; }},
                    BadValue{"wall[0].beta", [](Scene& s) { s.walls[0].beta = 0.5; }},
                    BadValue{"wall[0].beta", [](Scene& s) { s.walls[0].beta = -1.5; }},
                    BadValue{"wall[0].beta", [](Scene& s) { s.walls[0].beta = nan; }}));

INSTANTIATE_TEST_SUITE_P(
    TimeAndOutput, SceneLimits,
    testing::Values(BadValue{"time.step", [](Scene& s) { s.time.step = 0.0; }},
                    BadValue{"time.step", [](Scene& s) { s.time.step = -1e-6; }},
                    BadValue{"time.step", [](Scene& s) { s.time.step = nan; }},
                    BadValue{"time.end", [](Scene& s) { s.time.end = -1.0; }},
                    BadValue{"time.end", [](Scene& s) { s.time.end = 1e30; }},
                    BadValue{"time.method", [](Scene& s) { s.time.method = "euler"; }},
                    BadValue{"output.frames_every", [](Scene& s) { s.output.frames_every = 0.0; }},
                    BadValue{"output.frames_every", [](Scene& s) { s.output.frames_every = nan; }},
                    BadValue{"output.frames_at[1]",
                             [](Scene& s) {
                               s.output.frames_at = {0.0, 16.0};
                             }},
                    BadValue{"output.frames_at",
                             [](Scene& s) {
                               s.output.frames_every = 1.0;
                               s.output.frames_at = {1.0};
                             }},
                    BadValue{"output.monitor_every",
                             [](Scene& s) { s.output.monitor_every = 0.0; }}));

}  // namespace
}  // namespace bounce
