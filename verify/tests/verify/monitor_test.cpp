#include "verify/watch/monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "verify/oracle/oracle.hpp"
#include "verify/tests/paper_scenes.hpp"

namespace bounce {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

bool mentions(const Trouble& trouble, const std::string& text) {
  return trouble.what.find(text) != std::string::npos;
}

// The same sums, plainly, in long double: V(R) = E (-u/2 + R0^2 u^2/4), u = 1/R^2.
struct Reference {
  long double kinetic = 0, bond = 0, gravity = 0, spin = 0;
};
Reference reference(const Problem& p, const State& s) {
  Reference sums;
  long double cx = 0;
  long double cy = 0;
  const BondList& bonds = p.bonds;
  for (std::size_t i = 0; i < s.size(); ++i) {
    cx += s.x[i] / 360.0L;
    cy += s.y[i] / 360.0L;
  }
  for (std::size_t i = 0; i < s.size(); ++i) {
    const long double x = s.x[i], y = s.y[i], vx = s.vx[i], vy = s.vy[i];
    sums.kinetic += (vx * vx + vy * vy) / 2;
    sums.gravity -= p.gravity.x * x + p.gravity.y * y;
    sums.spin += (x - cx) * vy - (y - cy) * vx;
    for (auto e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto j = static_cast<std::size_t>(bonds.neighbour[static_cast<std::size_t>(e)]);
      const BondClass& bond = p.classes[bonds.bond_class[static_cast<std::size_t>(e)]];
      const long double dx = x - s.x[j], dy = y - s.y[j];
      const long double u = 1 / (dx * dx + dy * dy);
      sums.bond += (-bond.attraction * u / 2 + bond.repulsion * u * u / 4) / 2;  // from both ends
    }
  }
  return sums;
}

TEST(Measure, AgreesWithLongDoubleSums) {
  Scene scene = paper_scene(5);
  scene.gravity = {0.5, -0.098};
  const Problem problem = make_problem(scene);
  Oracle oracle(scene, problem.initial);
  oracle.step(300);
  const State state = oracle.state();
  const Sample sample = measure(problem, state);
  const Reference expected = reference(problem, state);
  // Terms are good to some 3 roundings each, their compensated sum adds one.
  const auto near = [](double value, long double wanted) {
    EXPECT_NEAR(value, static_cast<double>(wanted), 1e-15 * std::abs(static_cast<double>(wanted)));
  };
  near(sample.kinetic, expected.kinetic);
  near(sample.bond, expected.bond);
  // Here signs differ, so the terms count: 360 of 5 and 1 erg; 360 of 40 cm^2/s.
  EXPECT_NEAR(sample.gravity, static_cast<double>(expected.gravity), 1e-12);
  EXPECT_NEAR(sample.angular_momentum, static_cast<double>(expected.spin), 1e-11);
  EXPECT_NEAR(sample.momentum.x, 360.0 * (4.0 + 0.5 * 300e-6), 1e-9);
  EXPECT_NEAR(sample.centre.x, 4.0 * 300e-6, 1e-6);
}

TEST(Measure, SumsAreCompensated) {
  const Problem problem = make_problem(paper_scene(2));
  State state = problem.initial;
  state.vx[0] = 1e17;
  for (std::size_t i = 1; i < 359; ++i) state.vx[i] = 1.0;  // each below half a digit of 1e17
  state.vx[359] = -1e17;
  EXPECT_EQ(measure(problem, state).momentum.x, 358.0);
}

TEST(Measure, NamesTheTightestBond) {
  const Problem problem = make_problem(paper_scene(2));
  State state = problem.initial;
  EXPECT_NEAR(measure(problem, state).smallest_ratio, 1.0, 1e-3);  // four decimals of 0.26 cm
  state.x[250] = state.x[251] + 0.1;
  state.y[250] = state.y[251];
  const Sample sample = measure(problem, state);
  EXPECT_NEAR(sample.smallest_ratio, 0.1 / std::sqrt(0.1343), 1e-12);
  EXPECT_EQ(sample.ratio_first, 250);
  EXPECT_EQ(sample.ratio_second, 251);
}

TEST(Measure, CountsParticlesOnAnyWallOnce) {
  const Problem problem = make_problem(paper_scene(7));
  State state = problem.initial;
  // Example 7 starts touching its incline: the nearest particle of 120 is 7 (1 - cos(1.5 deg))
  // away.
  EXPECT_LE(measure(problem, state).on_wall, 2);
  const auto before = measure(problem, state).on_wall;
  state.x[300] = 20.0;  // on the axis alone
  state.y[300] = 0.5 * contact_distance;
  state.x[310] = 0.0;  // in the corner: on both
  state.y[310] = 0.0;
  state.x[320] = 20.0;  // behind
  state.y[320] = -1.0;
  state.x[330] = 20.0;  // near
  state.y[330] = 2.0 * contact_distance;
  const Sample sample = measure(problem, state);
  EXPECT_EQ(sample.on_wall, before + 3);
  EXPECT_EQ(sample.lowest, -1.0);
}

TEST(Measure, KeepsNaN) {
  const Problem problem = make_problem(paper_scene(2));
  State state = problem.initial;
  state.y[7] = nan;
  const Sample sample = measure(problem, state);
  EXPECT_TRUE(std::isnan(sample.bond));
  EXPECT_TRUE(std::isnan(sample.smallest_ratio));
  EXPECT_TRUE(std::isnan(sample.lowest));
  EXPECT_TRUE(std::isnan(sample.total()));
  EXPECT_TRUE(sample.ratio_first == 7 || sample.ratio_second == 7);
}

class WatchTest : public testing::Test {
 protected:
  [[nodiscard]] std::optional<Trouble> check(const State& state) const {
    return watch_.check(state, measure(problem_, state));
  }
  Problem problem_ = make_problem(paper_scene(2));
  State state_ = problem_.initial;
  Watch watch_{problem_, state_};
};

TEST_F(WatchTest, PassesTheStart) { EXPECT_FALSE(check(state_)); }

TEST_F(WatchTest, CatchesEveryNumberThatIsNotFinite) {
  for (auto member : {&State::x, &State::y, &State::vx, &State::vy}) {
    for (const double bad : {nan, infinity, -infinity}) {
      State state = state_;
      (state.*member)[122] = bad;
      const auto trouble = check(state);
      ASSERT_TRUE(trouble);
      EXPECT_EQ(trouble->particle, 122);
      EXPECT_EQ(trouble->bond_first, 122);
      EXPECT_GE(trouble->bond_second, 0);
      EXPECT_TRUE(mentions(*trouble, "particle 123")) << trouble->what;
      EXPECT_TRUE(mentions(*trouble, "bond 123-")) << trouble->what;
    }
  }
}

TEST_F(WatchTest, CatchesParticlesInOnePlace) {
  State state = state_;
  state.x[3] = state.x[4];
  state.y[3] = state.y[4];
  const auto trouble = check(state);
  ASSERT_TRUE(trouble);
  EXPECT_TRUE(mentions(*trouble, "bond 4-5")) << trouble->what;
}

// Finite positions whose energy overflows, downwards too.
TEST_F(WatchTest, CatchesEnergyThatIsNotFinite) {
  State state = state_;
  state.vx[0] = 1e200;
  EXPECT_TRUE(check(state));
  Sample sample = measure(problem_, state_);
  sample.bond = -infinity;
  EXPECT_TRUE(watch_.check(state_, sample));
  sample.bond = nan;
  EXPECT_TRUE(watch_.check(state_, sample));
}

TEST_F(WatchTest, CatchesAnEnergyJumpAndNamesTheBond) {
  const double limit = watch_.allowed_gain();
  Sample sample = measure(problem_, state_);
  sample.kinetic += 0.9 * limit;
  EXPECT_FALSE(watch_.check(state_, sample));
  sample.kinetic += 0.2 * limit;
  // On ring 1 bond 1-2 pulled apart, its room taken from the sixty bonds behind it: these and bonds
  // to ring 2 are tighter, but have less energy.
  State state = state_;
  const double spacing = 2.0 * std::numbers::pi / 120.0;
  for (std::size_t k = 1; k <= 60; ++k) {
    const double share = 1.0 - static_cast<double>(k - 1) / 60.0;
    const double angle = spacing * (static_cast<double>(k) + 0.3 * share);
    state.x[k] = 5.0 * std::cos(angle);
    state.y[k] = 10.0 + 5.0 * std::sin(angle);
  }
  EXPECT_NE(measure(problem_, state).ratio_first, 0);
  const auto trouble = watch_.check(state, sample);
  ASSERT_TRUE(trouble);
  EXPECT_TRUE(mentions(*trouble, "energy jumped by")) << trouble->what;
  EXPECT_TRUE(mentions(*trouble, "bond 1-2 is at R/R0 = 1.3")) << trouble->what;
  EXPECT_EQ(trouble->particle, 0);
  EXPECT_EQ(trouble->bond_second, 1);
}

// What falls may move: all that gravity can give until the ball lies on the floor, however often
// one has looked. 360 particles, their mean 10 cm up.
TEST_F(WatchTest, AllowsWhatTheFallToTheWallsGives) {
  Problem open = problem_;
  open.walls.clear();
  const double without = Watch(open, state_).allowed_gain();
  EXPECT_NEAR(watch_.allowed_gain() - without, 360 * 0.098 * 10.0, 1e-3);
  Sample sample = measure(problem_, state_);
  sample.gravity -= 100.0;
  sample.kinetic += 100.0;
  watch_.accept(sample);
  EXPECT_NEAR(watch_.allowed_gain() - without, 360 * 0.098 * 10.0, 1e-3);
}

// A wedge of two slopes has a lowest point, (3, 1); a single slope has none.
TEST_F(WatchTest, AllowsTheFallIntoAWedge) {
  const double h = std::sqrt(0.5);
  Problem wedge = problem_;
  wedge.walls = {Wall{{h, h}, 4.0 * h}, Wall{{-h, h}, -2.0 * h}};
  const double open = [&] {
    Problem slope = wedge;
    slope.walls.pop_back();
    return Watch(slope, state_).allowed_gain();
  }();
  EXPECT_NEAR(Watch(wedge, state_).allowed_gain() - open, 360 * 0.098 * 9.0, 1e-3);
}

// Without a floor the fall has no end: what has been set free, be it just now, may move.
TEST_F(WatchTest, AllowsAnEndlessFall) {
  Problem open = problem_;
  open.walls.clear();
  Watch watch(open, state_);
  const double before = watch.allowed_gain();
  Sample sample = measure(open, state_);
  sample.gravity -= 1000.0;
  sample.kinetic += 1000.0 + before + 990.0;  // gained: before + 990
  EXPECT_FALSE(watch.check(state_, sample));
  sample.kinetic += 20.0;
  EXPECT_TRUE(watch.check(state_, sample));
  sample.kinetic -= 20.0;
  watch.accept(sample);
  EXPECT_NEAR(watch.allowed_gain(), before + 1000.0, 1e-9);
}

// The steps are 1e-6 s, the shortest bonds 0.2618 cm: what comes to the floor at 3e5 cm/s moves by
// more than that; what moves along it, or a whole ball without walls, does no harm.
TEST_F(WatchTest, NamesWhatMayPassThroughAWall) {
  State state = state_;
  for (std::size_t i = 0; i < state.size(); ++i) state.vy[i] = -2e5;
  EXPECT_LT(stride_of(problem_, measure(problem_, state)).wall, 1.0);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.vx[i] = 9e5;
    state.vy[i] = -3e5;
  }
  state.vy[40] = -3.0001e5;
  state.vx[7] = 9.5e5;  // the fastest, but along the floor
  const auto trouble = check(state);
  ASSERT_TRUE(trouble);
  EXPECT_TRUE(mentions(*trouble, "particle 41 moves by 1.15 times")) << trouble->what;
  EXPECT_TRUE(mentions(*trouble, "through a wall")) << trouble->what;
  Problem open = problem_;
  open.walls.clear();
  EXPECT_LT(stride_of(open, measure(open, state)).wall, 1.0);
}

TEST_F(WatchTest, NamesTheBondWhoseEndsMayPassEachOther) {
  State state = state_;
  state.vx[4] = 3e5;
  state.vx[3] = -1000.0;
  const auto trouble = check(state);
  ASSERT_TRUE(trouble);
  EXPECT_TRUE(mentions(*trouble, "particles 4 and 5, which a bond joins, move by 1.15"))
      << trouble->what;
  EXPECT_EQ(trouble->bond_first, 3);
  EXPECT_EQ(trouble->bond_second, 4);
  state.vx[4] = 2e5;
  EXPECT_LT(stride_of(problem_, measure(problem_, state)).bond, 1.0);
}

// Energy that grows by 1 % a look is still growing when every single look seems harmless.
TEST_F(WatchTest, CatchesSlowGrowth) {
  const Sample start = measure(problem_, state_);
  const double limit = watch_.allowed_gain();
  double spurious = 1e-6;
  int looks = 0;
  for (; looks < 100000; ++looks) {
    Sample sample = start;
    sample.kinetic += spurious;
    if (watch_.check(state_, sample)) break;
    watch_.accept(sample);
    spurious *= 1.01;
  }
  EXPECT_LE(spurious, 1.02 * limit);
}

// A ball at rest to the last digit has no motion to compare with; rounding must not stop it.
TEST(Watch, ExactRestIsLeftAlone) {
  Scene scene = paper_scene(2);
  scene.constants = Constants::double_precision;
  scene.law.rest = Rest::geometry;
  scene.ball.rounding = Rounding::none;
  scene.gravity = {};
  const Problem problem = make_problem(scene);
  Watch watch(problem, problem.initial);
  Sample rounded = measure(problem, problem.initial);
  rounded.bond += 1e-10 * std::abs(rounded.bond);  // a million roundings
  EXPECT_FALSE(watch.check(problem.initial, rounded));
  Oracle oracle(scene, problem.initial);
  for (int look = 0; look < 20; ++look) {
    oracle.step(100);
    const Sample sample = measure(problem, oracle.state());
    EXPECT_FALSE(watch.check(oracle.state(), sample)) << "look " << look;
    watch.accept(sample);
  }
}

// Steps of `dt` until the watch stops the run; -1 if it never does in `looks` looks of 20 steps.
int looks_until_trouble(double dt, int looks, State& last) {
  Scene scene = paper_scene(2);
  scene.time.step = dt;
  const Problem problem = make_problem(scene);
  Watch watch(problem, problem.initial);
  Oracle oracle(scene, problem.initial);
  for (int look = 1; look <= looks; ++look) {
    oracle.step(20);
    last = oracle.state();
    const Sample sample = measure(problem, last);
    if (watch.check(last, sample)) return look;
    watch.accept(sample);
  }
  return -1;
}

// "To prevent instability", as the paper says: with E = 16000 steps beyond 3.83e-4 s are unstable.
// It has to be seen while the numbers are still finite.
TEST(Watch, StopsAnUnstableRunBeforeItOverflows) {
  State last;
  for (const double dt : {3.9e-4, 1e-3, 1e-2}) {
    EXPECT_GT(looks_until_trouble(dt, 100, last), 0) << dt;
    EXPECT_TRUE(is_finite(last)) << dt;
  }
}

TEST(Watch, LetsAStableRunGoOn) {
  State last;
  EXPECT_EQ(looks_until_trouble(1e-6, 100, last), -1);
  EXPECT_EQ(looks_until_trouble(1e-4, 100, last), -1);
  // Near the edge the energy swings by more than the ball has, and the run is stable all the same.
  EXPECT_EQ(looks_until_trouble(3.8e-4, 500, last), -1);
}

}  // namespace
}  // namespace bounce
