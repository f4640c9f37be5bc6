// The pair law: force, potential and stiffness belong to each other and to the paper.
#include <gsl/gsl_deriv.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/model/pair_law.hpp"
#include "kernels/model/powers.hpp"

namespace bounce {
namespace {

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
  // Per bond: E (-u/2 + R0^2 u^2/4).
  EXPECT_NEAR(potential({3, 5}, bond, 0.09), -8000.0 * u + 274.16 * u * u, 1e-10);
}

}  // namespace
}  // namespace bounce
