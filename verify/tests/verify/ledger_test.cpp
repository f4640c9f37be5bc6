// The ledgers close on sound kernels, to what rounding explains.
#include "verify/watch/ledger.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "verify/oracle/equivalence.hpp"
#include "verify/tests/kernels/method_names.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"
#include "verify/tests/verify/ledger_runs.hpp"
#include "verify/watch/booking_stepper.hpp"

namespace bounce {
namespace {

struct Sound {
  int example;
  std::string kernel;
  std::string method;
  Contact contact = Contact::listing;
};
void PrintTo(const Sound& s, std::ostream* out) { *out << s.example << s.kernel << s.method; }

class SoundKernel : public testing::TestWithParam<Sound> {};

TEST_P(SoundKernel, ClosesItsBooksInItsOwnBits) {
  Scene scene = at_wall(GetParam().example, GetParam().method, GetParam().contact);
  const int evaluations = find_method(GetParam().method)->evaluations;
  scene.time.step *= evaluations;
  const Problem problem = make_problem(scene);
  const Plan plan = plan_of(scene, problem, GetParam().kernel);
  const auto plain = plan.make_stepper();
  const auto with_books = make_booking_stepper(scene, problem, plan);
  const std::int64_t steps = 8000 / evaluations;  // contact begins at three quarters of it
  const std::int64_t every = 997 / evaluations;
  // Odd intervals, so that blocks and stages held over are cut anywhere.
  const LedgerReport full = booked(problem, *with_books, steps, every);
  const LedgerReport cheap = watched(problem, *plain, steps, every);
  EXPECT_TRUE(same_state(with_books->state(), plain->state()));
  EXPECT_TRUE(same_state(with_books->save().state, plain->save().state));
  EXPECT_TRUE(full.closes()) << print(full);
  EXPECT_TRUE(cheap.closes()) << print(cheap);
  EXPECT_GT(with_books->books().reflections(), 0);
  EXPECT_LT(cheap.free_share, 1.0);
  // What the one books to the walls reflection by reflection, the other finds from the samples.
  const double size = std::abs(full.impulse.x) + std::abs(full.impulse.y);
  EXPECT_NEAR(cheap.impulse.x, full.impulse.x, 1e-8 * size);
  EXPECT_NEAR(cheap.impulse.y, full.impulse.y, 1e-8 * size);
  // A few roundings of 2.6e7 erg, the bonds' energy.
  EXPECT_NEAR(full.change, full.walls + full.swing + full.drift, 1e-8);
  EXPECT_NEAR(cheap.change, cheap.walls + cheap.swing + cheap.drift, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(All, SoundKernel,
                         testing::ValuesIn(std::vector<Sound>{
                             {2, "oracle", "listing"},
                             {2, "strict", "listing"},
                             {2, "csr", "listing"},
                             {2, "ring", "listing"},
                             {2, "mirror", "listing"},
                             {2, "mirror", "leapfrog"},
                             {5, "oracle", "listing"},
                             {5, "strict", "listing"},
                             {5, "csr", "leapfrog"},
                             {5, "ring", "listing"},
                             {5, "ring", "leapfrog"},
                             {6, "strict", "listing"},
                             {6, "csr", "listing"},
                             {6, "ring", "leapfrog"},
                             {7, "oracle", "listing"},
                             {7, "strict", "listing"},
                             {7, "csr", "leapfrog"},
                             {7, "ring", "listing"},
                             {7, "ring", "leapfrog"},
                             {2, "mirror", "leapfrog", Contact::resolved},
                             {5, "csr", "listing", Contact::resolved},
                             {5, "ring", "leapfrog", Contact::resolved},
                             {7, "ring", "leapfrog", Contact::resolved},
                         }),
                         [](const auto& param) {
                           const Sound& s = param.param;
                           return "Example" + std::to_string(s.example) + s.kernel +
                                  test_name(s.method) +
                                  (s.contact == Contact::resolved ? "resolved" : "");
                         });

// A drift held over is finished on a copy, which may mirror a particle that the run then mirrors
// elsewhere: also an interval without any reflection of the run's own may then lie in contact.
// Looked at after each step, so that this happens.
TEST(Ledger, ClosesWhereAStepFinishedOnACopyMeetsTheWall) {
  for (const int example : {2, 5}) {
    Scene scene = at_wall(example, "pefrl");
    scene.time.step *= 20.0;
    const Problem problem = make_problem(scene);
    const Plan plan = plan_of(scene, problem, "ring");
    const auto stepper = make_booking_stepper(scene, problem, plan);
    const auto plain = plan.make_stepper();
    const LedgerReport full = booked(problem, *stepper, 700, 1);
    const LedgerReport cheap = watched(problem, *plain, 700, 1);
    EXPECT_TRUE(full.closes()) << print(full);
    EXPECT_TRUE(cheap.closes()) << print(cheap);
    EXPECT_GT(stepper->books().reflections(), 100);
  }
}

// In a wedge a particle may meet both walls in one step.
TEST(Ledger, ClosesBetweenTwoWalls) {
  Scene scene = paper_scene(6);
  scene.ball.rounding = Rounding::none;
  scene.ball.velocity = {0.0, -4.0};
  Wall left = scene.walls[0], right = scene.walls[0];
  left.normal = {0.8, 0.6};
  right.normal = {-0.6, 0.8};
  scene.walls = {left, right};
  scene.ball.centre = {7.001 * 0.8 - 7.001 * 0.6, 7.001 * 0.6 + 7.001 * 0.8};
  const Problem problem = make_problem(scene);
  const auto stepper = make_booking_stepper(scene, problem, plan_of(scene, problem, "ring"));
  const LedgerReport report = booked(problem, *stepper, 20000);
  EXPECT_TRUE(report.closes()) << print(report);
  EXPECT_GT(stepper->books().walls[0].reflections, 0);
  EXPECT_GT(stepper->books().walls[1].reflections, 0);
  // Both are elastic and frictionless: no reflection changes a speed.
  for (const WallBook& wall : stepper->books().walls) {
    EXPECT_NEAR(wall.kinetic.value(), 0.0, 1e-12);
  }
}

// What the full form calls drift in contact is the scheme's own error, of the order of the step.
TEST(Ledger, DriftInContactHalvesWithTheStep) {
  double drift[2] = {0.0, 0.0};
  for (int k = 0; k < 2; ++k) {
    Scene scene = at_wall(5);
    scene.constants = Constants::double_precision;
    scene.time.step = k == 0 ? 1e-6 : 5e-7;
    const Problem problem = make_problem(scene);
    const auto stepper = make_booking_stepper(scene, problem, plan_of(scene, problem, "ring"));
    const LedgerReport report = booked(problem, *stepper, k == 0 ? 10000 : 20000);
    EXPECT_TRUE(report.closes()) << print(report);
    drift[k] = report.drift;
  }
  EXPECT_LT(drift[0], -1e-3);
  EXPECT_NEAR(drift[0] / drift[1], 2.0, 0.1);  // measured 1.99 over 20000 steps
}

TEST(Ledger, BooksGoBackWithTheRun) {
  const Scene scene = at_wall(5);
  const Problem problem = make_problem(scene);
  const auto stepper = make_booking_stepper(scene, problem, plan_of(scene, problem, "ring"));
  stepper->advance(7000);
  const Snapshot middle = stepper->save();
  const std::int64_t then = stepper->books().reflections();
  stepper->advance(500);
  const std::int64_t later = stepper->books().reflections();
  const double energy = stepper->books().energy_given();
  EXPECT_GT(later, then);
  stepper->restore(middle);
  EXPECT_EQ(stepper->books().reflections(), then);
  stepper->advance(500);
  EXPECT_EQ(stepper->books().reflections(), later);
  EXPECT_EQ(stepper->books().energy_given(), energy);
}

TEST(Ledger, RefusesDisorderAndMissingBooks) {
  const Problem problem = make_problem(paper_scene(2));
  const Sample sample = measure(problem, problem.initial);
  Ledger ledger(problem);
  ledger.add(5, problem.initial, sample);
  EXPECT_THROW(ledger.add(5, problem.initial, sample), std::invalid_argument);
  Ledger full(problem, true);
  EXPECT_THROW(full.add(0, problem.initial, sample), std::invalid_argument);
}

TEST(Ledger, NaNNeverCloses) {
  const Problem problem = make_problem(paper_scene(2));
  for (auto member : {&State::x, &State::y, &State::vx, &State::vy}) {
    Ledger ledger(problem);
    State state = problem.initial;
    ledger.add(0, state, measure(problem, state));
    (state.*member)[7] = std::numeric_limits<double>::quiet_NaN();
    ledger.add(1, state, measure(problem, state));
    EXPECT_FALSE(ledger.report().closes());
  }
}

}  // namespace
}  // namespace bounce
