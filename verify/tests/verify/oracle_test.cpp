// The port of the listing: constants, cases, walls, frames, and the oracle as a kernel.
#include "verify/oracle/oracle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "kernels/model/problem.hpp"
#include "verify/oracle/oracle_stepper.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

State paper_start() { return make_problem(paper_scene(2)).initial; }

void expect_same_state(const State& a, const State& b) { EXPECT_TRUE(same_state(a, b)); }

TEST(Oracle, ConstantsAreTheListingsLiterals) {
  const Oracle oracle(paper_scene(2), paper_start());
  const Listing& b = oracle.listing();
  EXPECT_EQ(b.e, 16000.0);
  EXPECT_EQ(b.h11, static_cast<double>(1096.64F));
  EXPECT_EQ(b.h11, 1096.6400146484375);  // as FORTRAN reads 1096.64
  EXPECT_EQ(b.h12, 16328.0);
  EXPECT_EQ(b.h22, static_cast<double>(1578.4F));
  EXPECT_EQ(b.h23, static_cast<double>(16462.8F));
  EXPECT_EQ(b.h33, static_cast<double>(2148.8F));
  EXPECT_EQ(b.gx, 0.0);
  EXPECT_EQ(b.gy, -0.09799999743700027);
  EXPECT_EQ(b.dt, 9.999999974752427e-07);
}

TEST(Oracle, ConstantsForAnotherElasticityAreTypedTheSameWay) {
  const Oracle oracle(paper_scene(3), paper_start());
  const Listing& b = oracle.listing();
  EXPECT_EQ(b.e, 1000.0);
  EXPECT_EQ(b.h11, static_cast<double>(68.54F));
  EXPECT_EQ(b.h12, 1020.5);
  EXPECT_EQ(b.h22, static_cast<double>(98.65F));
  EXPECT_EQ(b.h23, static_cast<double>(1028.925F));
  EXPECT_EQ(b.h33, static_cast<double>(134.3F));
  EXPECT_EQ(b.gy, -static_cast<double>(0.98F));
}

TEST(Oracle, DoubleConstantsAreNotRounded) {
  Scene scene = paper_scene(2);
  scene.constants = Constants::double_precision;
  const Oracle oracle(scene, paper_start());
  EXPECT_EQ(oracle.listing().gy, -0.098);
  EXPECT_EQ(oracle.listing().dt, 1e-6);
  EXPECT_EQ(oracle.listing().h11, 16000.0 * 0.06854);
}

// The kernels make their constants on their own; `strict` can only have the oracle's bits if both
// agree.
void expect_problems_constants(const Scene& scene) {
  SCOPED_TRACE(scene.title);
  const Problem problem = make_problem(scene);
  const Oracle oracle(scene, problem.initial);
  const Listing& b = oracle.listing();
  const double repulsion[] = {b.h11, b.h12, b.h22, b.h23, b.h33};
  ASSERT_EQ(problem.classes.size(), 5U);
  for (std::size_t c = 0; c < 5; ++c) {
    EXPECT_TRUE(same_bits(problem.classes[c].attraction, b.e)) << c;
    EXPECT_TRUE(same_bits(problem.classes[c].repulsion, repulsion[c]))
        << c << ": " << problem.classes[c].repulsion - repulsion[c];
  }
  EXPECT_TRUE(same_bits(problem.gravity.x, b.gx));
  EXPECT_TRUE(same_bits(problem.gravity.y, b.gy));
  EXPECT_TRUE(same_bits(problem.step, b.dt));
}

TEST(Oracle, ConstantsAreTheProblems) {
  for (int example = 1; example <= 7; ++example) expect_problems_constants(paper_scene(example));
  for (const Constants constants : {Constants::single_precision, Constants::double_precision}) {
    Scene scene = paper_scene(2);
    scene.constants = constants;
    scene.law.rest = Rest::geometry;
    scene.title = "radii 5, 6, 7, geometry";
    expect_problems_constants(scene);
    scene.ball.radii = {10.0, 11.0, 12.0};
    scene.ball.centre.y = 15.0;
    scene.title = "radii 10, 11, 12, geometry";
    expect_problems_constants(scene);
  }
}

// Velocity after one step from rest, dt a, with a summed along the rows of the neighbour list in
// the listing's operations.
State one_step_along_rows(const Problem& problem) {
  const State& s = problem.initial;
  const BondList& bonds = problem.bonds;
  State after = s;
  for (std::size_t i = 0; i < s.size(); ++i) {
    double ax = 0.0;
    double ay = 0.0;
    const auto first = static_cast<std::size_t>(bonds.start[i]);
    const auto end = static_cast<std::size_t>(bonds.start[i + 1]);
    for (std::size_t e = first; e < end; ++e) {
      const auto j = static_cast<std::size_t>(bonds.neighbour[e]);
      const BondClass& bond = problem.classes[bonds.bond_class[e]];
      const double dx = s.x[i] - s.x[j];
      const double dy = s.y[i] - s.y[j];
      const double r = dx * dx + dy * dy;
      const double f = (-bond.attraction + bond.repulsion / r) / r;
      ax = e == first ? f * dx / r : ax + f * dx / r;
      ay = e == first ? f * dy / r : ay + f * dy / r;
    }
    after.vx[i] = problem.step * (ax + problem.gravity.x);
    after.vy[i] = problem.step * (ay + problem.gravity.y);
    after.x[i] = s.x[i] + problem.step * after.vx[i];
    after.y[i] = s.y[i] + problem.step * after.vy[i];
  }
  return after;
}

// Nine cases against the rule that they follow, all 360 particles, the same bits. Twenty disordered
// balls: sums in another order agree by chance about every second time.
TEST(Oracle, NineCasesAreTheNeighbourListInItsOrder) {
  Scene scene = paper_scene(2);
  scene.walls.clear();
  scene.gravity = {0.03125, -0.098};
  State start = paper_start();
  std::mt19937 random(121);
  std::uniform_real_distribution<double> shift(-0.01, 0.01);
  for (int ball = 0; ball < 20; ++ball) {
    for (std::size_t i = 0; i < start.size(); ++i) {
      start.x[i] += shift(random);
      start.y[i] += shift(random);
    }
    Oracle oracle(scene, start);
    oracle.step(1);
    expect_same_state(oracle.state(), one_step_along_rows(make_problem(scene, start)));
  }
}

TEST(Oracle, StepsAddUp) {
  Oracle whole(paper_scene(5), paper_start());
  Oracle parts(paper_scene(5), paper_start());
  whole.step(50);
  parts.step(20);
  parts.step(0);
  parts.step(30);
  expect_same_state(whole.state(), parts.state());
}

TEST(Oracle, RefusesWhatTheListingCannotDo) {
  EXPECT_EQ(Oracle::refusal(paper_scene(7)), "");
  const auto refusal_after = [](auto change) {
    Scene scene = paper_scene(2);
    change(scene);
    return Oracle::refusal(scene);
  };
  EXPECT_NE(refusal_after([](Scene& s) { s.ball.per_ring = 121; }), "");
  EXPECT_NE(refusal_after([](Scene& s) { s.ball.radii = {5.0, 6.0}; }), "");
  EXPECT_NE(refusal_after([](Scene& s) { s.ball.radii = {5.0, 6.0, 8.0}; }), "");
  EXPECT_NE(refusal_after([](Scene& s) { s.law.p = 2.0; }), "");
  EXPECT_NE(refusal_after([](Scene& s) { s.law.q = 7.0; }), "");
  EXPECT_NE(refusal_after([](Scene& s) { s.time.method = "leapfrog"; }), "");
  EXPECT_EQ(refusal_after([](Scene& s) {
              s.ball.radii = {10.0, 11.0, 12.0};
              s.law.rest = Rest::geometry;
            }),
            "");
  Scene scene = paper_scene(2);
  EXPECT_THROW(Oracle(scene, State(359)), std::invalid_argument);
  scene.law.p = 2.0;
  EXPECT_THROW(Oracle(scene, paper_start()), std::invalid_argument);
}

// Particles so far apart that squared distances overflow and all forces are exactly zero: each
// moves freely but for walls.
State scattered() {
  State state(360);
  for (std::size_t i = 0; i < 360; ++i) {
    state.x[i] = 1e200 * static_cast<double>(i % 19);
    state.y[i] = 1e200 * (1.0 + std::floor(static_cast<double>(i) / 19.0));
  }
  return state;
}

struct Hit {
  double y, vx, vy;
};

// Particle 1 alone at `start`, one step of 2^-20 s on one wall without gravity.
Hit one_step(Hit start, double alpha, double beta) {
  Scene scene = paper_scene(2);
  scene.gravity = {};
  scene.time.step = 0x1p-20;
  scene.walls.front().alpha = alpha;
  scene.walls.front().beta = beta;
  State state = scattered();
  state.y[0] = start.y;
  state.vx[0] = start.vx;
  state.vy[0] = start.vy;
  Oracle oracle(scene, state);
  oracle.step(1);
  const State after = oracle.state();
  return {after.y[0], after.vx[0], after.vy[0]};
}

TEST(OracleWalls, XAxisIsTheListings) {
  const double dt = 0x1p-20;
  const double down = -1024.0;
  const Hit hit = one_step({0x1p-12, 3.0, down}, 0.0, 0.0);
  EXPECT_EQ(hit.y, -(0x1p-12 + dt * down));
  EXPECT_TRUE(same_bits(hit.vx, 0.0));
  EXPECT_TRUE(same_bits(hit.vy, 0.0));
  const Hit free = one_step({0.5, 3.0, down}, 0.0, 0.0);
  EXPECT_EQ(free.y, 0.5 + dt * down);
  EXPECT_EQ(free.vx, 3.0);
  EXPECT_EQ(free.vy, down);
}

// "IF (Y .GT. 0.0) GO TO": a particle exactly on the axis is reflected.
TEST(OracleWalls, ZeroHeightIsBehind) {
  const Hit hit = one_step({0.0, 3.0, 0.0}, 0.0, 0.0);
  EXPECT_TRUE(same_bits(hit.vx, 0.0));
}

TEST(OracleWalls, XAxisTakesAlphaAndBeta) {
  const Hit hit = one_step({0x1p-12, 3.0, -1024.0}, 0.5, -0.25);
  EXPECT_EQ(hit.vx, 1.5);
  EXPECT_EQ(hit.vy, 256.0);
}

TEST(OracleWalls, InclineMirrorsInItsOwnAxes) {
  Scene scene = paper_scene(7);
  scene.gravity = {};
  scene.walls.front().alpha = 0.5;
  scene.walls.front().beta = -0.25;
  scene.walls.front().offset = 1.0;
  State state = scattered();
  // A point 1 cm behind the incline x + y = sqrt(2), moving 3 cm/s along and 4 cm/s into it.
  const double h = std::sqrt(0.5);
  state.x[0] = -10.0;
  state.y[0] = 10.0;
  state.vx[0] = 3.0 * h - 4.0 * h;
  state.vy[0] = -3.0 * h - 4.0 * h;
  Oracle oracle(scene, state);
  oracle.step(1);
  const State after = oracle.state();
  const double tol = 1e-4;  // the step moves it by 5e-6 cm
  EXPECT_NEAR(after.x[0], -10.0 + 2.0 * h, tol);
  EXPECT_NEAR(after.y[0], 10.0 + 2.0 * h, tol);
  EXPECT_NEAR(after.vx[0], 1.5 * h + 1.0 * h, 1e-12);
  EXPECT_NEAR(after.vy[0], -1.5 * h + 1.0 * h, 1e-12);
}

// A level wall off the X axis goes the general way; there it must do what the X axis does, but for
// rounding.
TEST(OracleWalls, GeneralWallIsTheXAxisMovedUp) {
  Scene low = paper_scene(2);
  low.walls.front().alpha = 0.5;
  low.walls.front().beta = -0.5;
  low.ball.centre = {0.0, 7.01};
  low.ball.velocity = {40.0, -200.0};
  Scene high = low;
  high.walls.front().offset = 1.0;
  high.ball.centre.y += 1.0;
  Oracle a(low, make_problem(low).initial);
  Oracle b(high, make_problem(high).initial);
  a.step(500);
  b.step(500);
  const State sa = a.state();
  const State sb = b.state();
  int reflected = 0;
  for (std::size_t i = 0; i < sa.size(); ++i) {
    // 500 steps of rounding 1e-15 cm with bonds that answer with 1e7 cm/s^2 a cm.
    EXPECT_NEAR(sb.y[i], sa.y[i] + 1.0, 1e-10);
    EXPECT_NEAR(sb.vx[i], sa.vx[i], 1e-6);
    reflected += sa.vy[i] > 50.0;
  }
  EXPECT_GE(reflected, 1);
}

TEST(ListingFrame, PrintsAsGfortranDoes) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  State state;
  state.x = {-0.00001, nan, 0.00015};
  state.y = {1234567.5, infinity, -0.5};
  state.vx = {-123456.00005, -infinity, 0.03125};
  state.vy = {12345678.0, 0.00005, -1e300};
  std::ostringstream out;
  write_listing_frame(out, state);
  // Output of gfortran 12 for these numbers.
  EXPECT_EQ(out.str(),
            "     -0.00001234567.5000-123456.0001************\n"
            "         NaN    Infinity   -Infinity      0.0001\n"
            "      0.0001     -0.5000      0.0312************\n");
}

TEST(ListingFrame, RoundTrip) {
  const State start = paper_start();
  std::stringstream file;
  write_listing_frame(file, start);
  expect_same_state(read_listing_frame(file), start);  // the start has four decimals
}

TEST(ListingFrame, ReadsColumnsThatTouchAndBlanks) {
  std::istringstream file(
      "      1.00001234567.5000-123456.0001      4.0000\r\n"
      "1 +2.5 -3e2 4\n"
      "\n");
  const State state = read_listing_frame(file);
  ASSERT_EQ(state.size(), 2U);
  EXPECT_EQ(state.y[0], 1234567.5);
  EXPECT_EQ(state.vx[0], -123456.0001);
  EXPECT_EQ(state.y[1], 2.5);
  EXPECT_EQ(state.vx[1], -300.0);
}

TEST(ListingFrame, NamesTheLineOfBadInput) {
  const auto message_of = [](const std::string& text) -> std::string {
    std::istringstream file(text);
    try {
      read_listing_frame(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(message_of("1 2 3 4\n1 2 3\n").find("line 2: 3 numbers"), std::string::npos);
  EXPECT_NE(message_of("1 2 3 4 5\n").find("line 1: 5 numbers"), std::string::npos);
  EXPECT_NE(message_of("1 2 x 4\n").find("line 1: \"x\""), std::string::npos);
  EXPECT_NE(message_of("1 2 NaN 4\n").find("line 1: \"NaN\""), std::string::npos);
  EXPECT_NE(message_of("1 2 inf 4\n").find("line 1"), std::string::npos);
  EXPECT_NE(message_of("1 2 1e999 4\n").find("line 1"), std::string::npos);
  EXPECT_NE(message_of("1 2 3 ************\n").find("line 1: \"****"), std::string::npos);
  EXPECT_NE(message_of("1 2 +-3 4\n").find("line 1"), std::string::npos);
  EXPECT_NE(message_of("1 2 3 4\n\n1 2 3 4\n").find("line 2: a blank line"), std::string::npos);
  EXPECT_NE(message_of("").find("empty"), std::string::npos);
  EXPECT_NE(message_of("\n\n").find("empty"), std::string::npos);
}

class OracleEntry : public testing::Test {
 protected:
  Scene scene_ = paper_scene(2);
  Problem problem_ = make_problem(scene_);
  std::vector<KernelEntry> entries_ = kernels_with_oracle(scene_);

  // Why the oracle cannot, or "".
  static std::string refusal(const Scene& scene, const Problem& problem,
                             const PlanRequest& request) {
    try {
      static_cast<void>(make_plan(problem, request, kernels_with_oracle(scene)));
    } catch (const PlanError& error) {
      return error.what();
    }
    return {};
  }
  [[nodiscard]] std::unique_ptr<Stepper> make_oracle() const {
    return make_stepper(problem_, {"oracle"}, entries_);
  }
};

TEST_F(OracleEntry, IsLastAndNeverAutomatic) {
  ASSERT_EQ(entries_.size(), kernels().size() + 1);
  EXPECT_EQ(entries_.back().name, "oracle");
  EXPECT_FALSE(entries_.back().automatic);
}

TEST_F(OracleEntry, RefusesThreadsVectorsAndOtherScenes) {
  const Plan plan = make_plan(problem_, {"oracle"}, entries_);
  EXPECT_EQ(plan.threads, 1);
  EXPECT_EQ(plan.lanes, 1);
  EXPECT_EQ(refusal(scene_, problem_, {"oracle", "auto", 1}), "");
  EXPECT_NE(refusal(scene_, problem_, {"oracle", "auto", 2}).find("one thread"), std::string::npos);
  EXPECT_NE(refusal(scene_, problem_, {"oracle", "avx2", 0}).find("no vectors"), std::string::npos);
  scene_.time.method = "leapfrog";
  EXPECT_NE(refusal(scene_, make_problem(scene_), {"oracle"}).find("cannot run this scene"),
            std::string::npos);
}

TEST_F(OracleEntry, StepsAsTheOracleAndRestores) {
  const auto stepper = make_oracle();
  stepper->advance(10);
  const Snapshot half = stepper->save();
  EXPECT_EQ(half.step, 10);
  EXPECT_FALSE(half.stage_held);
  stepper->advance(10);
  EXPECT_EQ(stepper->step(), 20);
  Oracle oracle(scene_, problem_.initial);
  oracle.step(20);
  expect_same_state(stepper->state(), oracle.state());
  const auto other = make_oracle();
  other->restore(half);
  other->advance(10);
  EXPECT_EQ(other->step(), 20);
  expect_same_state(other->state(), oracle.state());
  Snapshot pending = half;
  pending.stage_held = true;
  EXPECT_THROW(other->restore(pending), std::invalid_argument);
}

}  // namespace
}  // namespace bounce
