// The Hessian against differences of forces, Lanczos against the dense solver and against the one
// ring that can be solved by hand, the bound against both.
#include "verify/vibrations/spectrum.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Scene ball_scene(std::vector<double> radii, std::int64_t per_ring, double p = 3, double q = 5) {
  Scene scene;
  scene.constants = Constants::double_precision;
  scene.ball.radii = std::move(radii);
  scene.ball.per_ring = per_ring;
  scene.ball.rounding = Rounding::none;
  scene.law = {.p = p, .q = q, .elasticity = 16000.0, .rest = Rest::geometry};
  return scene;
}

// Every coordinate moved by up to `by` of the shortest rest length.
State disturbed(const Problem& problem, double by, unsigned seed) {
  double rest = infinity;
  for (const BondClass& bond : problem.classes) rest = std::min(rest, bond.rest);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-by * rest, by * rest);
  State state = problem.initial;
  for (double& x : state.x) x += move(random);
  for (double& y : state.y) y += move(random);
  return state;
}

State squeezed(const Problem& problem, double to) {
  State state = problem.initial;
  for (double& y : state.y) y = 10.0 + to * (y - 10.0);
  return state;
}

double dense_largest(const Problem& problem, const State& state) {
  const Eigen::MatrixXd dense = bond_hessian(problem, state);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

// Force on each particle, x1, y1, x2, ...
Eigen::VectorXd forces(const Problem& problem, const State& s) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * s.size()));
  const BondList& bonds = problem.bonds;
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (auto e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto at = static_cast<std::size_t>(e);
      const auto j = static_cast<std::size_t>(bonds.neighbour[at]);
      const double dx = s.x[i] - s.x[j], dy = s.y[i] - s.y[j];
      const double f = force_over_distance(problem.law, problem.classes[bonds.bond_class[at]],
                                           dx * dx + dy * dy);
      sum[static_cast<Eigen::Index>(2 * i)] += f * dx;
      sum[static_cast<Eigen::Index>(2 * i + 1)] += f * dy;
    }
  }
  return sum;
}

// States of all kinds of scenes, at rest, pressed, torn and tangled.
struct Case {
  std::string name;
  Problem problem;
  State state;
};
std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&all](const std::string& name, const Scene& scene) {
    const Problem problem = make_problem(scene);
    all.push_back({name, problem, problem.initial});
    all.push_back({name + " squeezed", problem, squeezed(problem, 0.6)});
    all.push_back({name + " stretched", problem, squeezed(problem, 3.0)});
    all.push_back({name + " shaken", problem, disturbed(problem, 0.1, 1)});
    all.push_back({name + " tangled", problem, disturbed(problem, 1.0, 2)});
  };
  add("example 1", paper_scene(1));
  add("example 2", paper_scene(2));
  add("example 7", paper_scene(7));
  Scene law = ball_scene({5, 6, 7}, 120, 2, 4);
  add("(2, 4)", law);
  add("(7, 13)", ball_scene({5, 6, 7}, 120, 7, 13));
  add("one ring", ball_scene({5}, 60));
  add("two rings", ball_scene({5, 6}, 90));
  add("four rings", ball_scene({4, 5, 6, 7}, 50));
  add("ring of three", ball_scene({1}, 3));
  add("nearly touching", ball_scene({5, 5.01, 5.02}, 40));
  return all;
}

TEST(Hessian, IsTheDifferenceOfForces) {
  for (const auto& [p, q] : {std::pair{3.0, 5.0}, {2.0, 4.0}, {7.0, 13.0}}) {
    const Problem problem = make_problem(ball_scene({4, 5, 6, 7}, 20, p, q));
    const State state = disturbed(problem, 0.1, 3);
    const Eigen::MatrixXd hessian = bond_hessian(problem, state);
    const double size = hessian.cwiseAbs().maxCoeff();
    constexpr double h = 1e-4;  // cm, of a shortest distance of 1.1 cm
    for (std::size_t i = 0; i < state.size(); ++i) {
      for (auto member : {&State::x, &State::y}) {
        State up = state, down = state;
        (up.*member)[i] += h;
        (down.*member)[i] -= h;
        const Eigen::VectorXd column = -(forces(problem, up) - forces(problem, down)) / (2 * h);
        const auto c = static_cast<Eigen::Index>(2 * i + (member == &State::y ? 1 : 0));
        // (h/R)^2 times q^2/6 or so for the next term; rounding is 1e-16 R/h of it.
        EXPECT_LE((column - hessian.col(c)).cwiseAbs().maxCoeff(), 1e-6 * size) << p << " " << i;
      }
    }
  }
}

TEST(Hessian, IsSymmetricAndBlindToTranslation) {
  for (const Case& each : cases()) {
    const Eigen::MatrixXd hessian = bond_hessian(each.problem, each.state);
    EXPECT_TRUE(hessian == hessian.transpose()) << each.name;
    Eigen::VectorXd along_x = Eigen::VectorXd::Zero(hessian.rows());
    for (Eigen::Index i = 0; i < along_x.size(); i += 2) along_x[i] = 1.0;
    // Six blocks add up to the seventh but for rounding.
    EXPECT_LE((hessian * along_x).cwiseAbs().maxCoeff(), 1e-14 * hessian.cwiseAbs().maxCoeff())
        << each.name;
  }
}

// Lanczos stops at a residual of 1e-7, which bounds the error; its square over the gap is the usual
// size. It is never above the largest eigenvalue but for rounding. The bound never is below.
TEST(Spectrum, LanczosIsTheDenseSolversAndTheBoundIsAbove) {
  for (const Case& each : cases()) {
    const double dense = dense_largest(each.problem, each.state);
    const auto found = fastest_vibration(each.problem, each.state);
    ASSERT_TRUE(found) << each.name;
    EXPECT_TRUE(found->exact) << each.name;
    const double lambda = found->omega * found->omega;
    EXPECT_NEAR(lambda, dense, fine_tolerance * dense) << each.name;
    EXPECT_LE(lambda, dense * (1.0 + 1e-13)) << each.name;
    EXPECT_GE(found->bound.lambda, dense) << each.name;
    const auto coarse =
        largest_eigenvalue(bond_hessian(each.problem, each.state), coarse_tolerance);
    ASSERT_TRUE(coarse) << each.name;
    EXPECT_NEAR(*coarse, dense, coarse_tolerance * dense) << each.name;
  }
}

// A ring of n at rest, k = V''(R0), has one vibration a wave number m: with a = pi/n, f = pi m/n,
// lambda = 4 k (sin^2 f cos^2 a + cos^2 f sin^2 a); largest, for even n, at m = n/2: 4 k cos^2 a.
TEST(Spectrum, OneRingIsTheOneByHand) {
  for (const std::int64_t n : {3, 4, 5, 60, 121, 1000}) {
    const Problem problem = make_problem(ball_scene({5}, n));
    const double rest = problem.classes[0].rest;
    const double k = 2.0 * 16000.0 / std::pow(rest, 4);  // (q - p) E / R0^(p+1)
    const double a = std::numbers::pi / static_cast<double>(n);
    double expected = 0.0;
    for (std::int64_t m = 0; m < n; ++m) {
      const double s = std::sin(a * static_cast<double>(m)),
                   c = std::cos(a * static_cast<double>(m));
      expected =
          std::max(expected, 4 * k * (std::pow(s * std::cos(a), 2) + std::pow(c * std::sin(a), 2)));
    }
    const auto found = fastest_vibration(problem, problem.initial);
    ASSERT_TRUE(found) << n;
    // Positions of 5 cm are good to 1e-15, bonds of R0 to 1e-15 (5 / R0), stiffness to 6 times
    // that.
    EXPECT_NEAR(found->omega * found->omega, expected, (fine_tolerance + 3e-14 / rest) * expected)
        << n;
    EXPECT_GE(found->bound.lambda, expected * (1.0 - 3e-14 / rest)) << n;
  }
}

// A thousand states against Lanczos, whose answer is never too large.
TEST(Spectrum, TheBoundHoldsOnRandomStates) {
  for (const auto& [p, q] : {std::pair{3.0, 5.0}, {2.0, 4.0}, {7.0, 13.0}, {1.0, 2.0}}) {
    const Problem problem = make_problem(ball_scene({4, 5, 6}, 12, p, q));
    for (unsigned seed = 0; seed < 250; ++seed) {
      const State state = disturbed(problem, 0.004 * seed, seed);
      const auto found = fastest_vibration(problem, state);
      ASSERT_TRUE(found && found->exact) << seed;
      EXPECT_LE(found->omega * found->omega, found->bound.lambda) << p << " " << seed;
    }
  }
}

// What is said of the bound: 0.3 % of the frequency at the start of the examples.
TEST(Spectrum, TheBoundIsTightAtRest) {
  for (int example = 1; example <= 7; ++example) {
    const Problem problem = make_problem(paper_scene(example));
    const auto found = fastest_vibration(problem, problem.initial);
    ASSERT_TRUE(found);
    EXPECT_LE(std::sqrt(found->bound.lambda), 1.003 * found->omega) << example;
  }
}

TEST(Spectrum, NamesTheStiffestBond) {
  const Problem problem = make_problem(paper_scene(2));
  State state = problem.initial;
  state.x[40] = state.x[41] + 0.1;  // ring 1
  state.y[40] = state.y[41];
  const auto bound = stiffness_bound(problem, state);
  ASSERT_TRUE(bound);
  EXPECT_EQ(bound->first, 40);
  EXPECT_EQ(bound->second, 41);
  EXPECT_NEAR(bound->ratio, 0.1 / std::sqrt(0.06854), 1e-12);
}

// lambda is proportional to E, whatever the size of E.
TEST(Spectrum, ScalesWithElasticity) {
  const auto omega = [](double elasticity) {
    Scene scene = ball_scene({5, 6, 7}, 120);
    scene.law.elasticity = elasticity;
    const Problem problem = make_problem(scene);
    return fastest_vibration(problem, problem.initial).value().omega;
  };
  const double unit = omega(1.0);
  for (const double e : {1e-100, 1e-6, 1e12, 1e100}) {
    EXPECT_NEAR(omega(e), unit * std::sqrt(e), 1e-9 * unit * std::sqrt(e)) << e;
  }
}

TEST(Spectrum, IsTheSameEachTime) {
  const Problem problem = make_problem(paper_scene(2));
  const State state = disturbed(problem, 0.1, 9);
  const double once = fastest_vibration(problem, state).value().omega;
  EXPECT_TRUE(same_bits(once, fastest_vibration(problem, state).value().omega));
}

TEST(Spectrum, NothingIsSaidOfStatesThatAreNotFinite) {
  const Problem problem = make_problem(paper_scene(2));
  std::vector<State> bad;
  for (const double value : {nan, infinity, -infinity}) {
    for (auto member : {&State::x, &State::y}) {
      for (const std::size_t i : {0, 200, 359}) {
        bad.push_back(problem.initial);
        (bad.back().*member)[i] = value;
      }
    }
  }
  bad.push_back(problem.initial);  // two in one place
  bad.back().x[5] = bad.back().x[6];
  bad.back().y[5] = bad.back().y[6];
  bad.push_back(problem.initial);  // R^6 underflows
  bad.back().x[5] = bad.back().x[6];
  bad.back().y[5] = bad.back().y[6] + 1e-60;
  for (std::size_t k = 0; k < bad.size(); ++k) {
    EXPECT_FALSE(stiffness_bound(problem, bad[k])) << k;
    EXPECT_FALSE(fastest_vibration(problem, bad[k])) << k;
    EXPECT_FALSE(largest_eigenvalue(bond_hessian(problem, bad[k]), fine_tolerance)) << k;
  }
}

// Too large for Lanczos: the bound stands in, and says so.
TEST(Spectrum, AVeryLargeBallHasItsBound) {
  const auto n = static_cast<std::int64_t>(lanczos_particles) / 3 + 1;
  const Problem problem = make_problem(ball_scene({5, 6, 7}, n));
  const auto found = fastest_vibration(problem, problem.initial);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->exact);
  EXPECT_TRUE(same_bits(found->omega, std::sqrt(found->bound.lambda)));
  // Its inner ring is nearly straight: 4 V''(R0), and next to nothing from the other rings.
  const double expected = std::sqrt(4.0 * 2.0 * 16000.0) / std::pow(problem.classes[0].rest, 2);
  EXPECT_NEAR(found->omega, expected, 1e-4 * expected);
}

}  // namespace
}  // namespace bounce
