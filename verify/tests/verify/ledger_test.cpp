// The ledgers close on sound kernels, to what rounding explains, and each notices the kernel that
// breaks it. The broken kernels are real ones whose results or problems are tampered with: a force
// that differs a little between a bond's two ends, a potential that is not that of the force, a
// reflection that is left out, or done otherwise.
#include "verify/watch/ledger.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>

#include "verify/oracle/equivalence.hpp"
#include "verify/oracle/oracle_stepper.hpp"
#include "verify/tests/kernels/method_names.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/vibrations/stability_limit.hpp"
#include "verify/watch/booking_stepper.hpp"

namespace bounce {
namespace {

Plan plan_of(const Scene& scene, const Problem& problem, const std::string& kernel) {
  PlanRequest request;
  request.kernel = kernel;
  request.threads = 1;
  return make_plan(problem, request, kernels_with_oracle(scene));
}

const LedgerLine& line(const LedgerReport& report, const std::string& name) {
  for (const LedgerLine& l : report.lines) {
    if (l.name == name) return l;
  }
  throw std::logic_error("no ledger line " + name);
}

std::string print(const LedgerReport& report) {
  std::ostringstream text;
  for (const LedgerLine& l : report.lines) {
    text << l.name << ": " << l.residual << ", walk " << l.likely << ", allowed " << l.allowed
         << ", fault at " << l.fault_step << "\n";
  }
  text << report.missed << " missed, " << report.otherwise << " otherwise";
  return text.str();
}

void look(Ledger& ledger, const Problem& problem, const Stepper& stepper,
          const WallBooks* books = nullptr) {
  const State state = stepper.state();
  ledger.add(stepper.step(), state, measure(problem, state), books);
}

// A run watched by the cheap ledger.
LedgerReport watched(const Problem& problem, Stepper& stepper, std::int64_t steps,
                     std::int64_t every = 1000) {
  Ledger ledger(problem);
  look(ledger, problem, stepper);
  while (stepper.step() < steps) {
    stepper.advance(every);
    look(ledger, problem, stepper);
  }
  return ledger.report();
}

// A run with books.
LedgerReport booked(const Problem& problem, BookingStepper& stepper, std::int64_t steps,
                    std::int64_t every = 1000) {
  Ledger ledger(problem, true);
  look(ledger, problem, stepper, &stepper.books());
  while (stepper.step() < steps) {
    stepper.advance(every);
    look(ledger, problem, stepper, &stepper.books());
  }
  return ledger.report();
}

Scene at_wall(int example, const std::string& method = "listing",
              Contact contact = Contact::listing) {
  Scene scene = at_the_wall(paper_scene(example));
  scene.time.method = method;
  for (Wall& wall : scene.walls) wall.contact = contact;
  return scene;
}

// -------------------------------------------------------------------- sound kernels

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
  EXPECT_EQ(state_hash(with_books->state()), state_hash(plain->state()));
  EXPECT_EQ(state_hash(with_books->save().state), state_hash(plain->save().state));
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

// -------------------------------------------------------------------- the modified energy

TEST(ModifiedEnergy, IsThatOfTheLiterature) {
  // Hairer, Lubich, Wanner, Geometric Numerical Integration, IX: symplectic Euler and
  // Stoermer-Verlet.
  const ModifiedEnergy euler = modified_energy(*find_method("listing"));
  EXPECT_DOUBLE_EQ(euler.first, -1.0 / 2);
  EXPECT_DOUBLE_EQ(euler.stiffness, 1.0 / 12);
  EXPECT_DOUBLE_EQ(euler.force, 1.0 / 12);
  const ModifiedEnergy verlet = modified_energy(*find_method("leapfrog"));
  EXPECT_NEAR(verlet.first, 0.0, 1e-16);
  EXPECT_DOUBLE_EQ(verlet.stiffness, 1.0 / 12);
  EXPECT_DOUBLE_EQ(verlet.force, -1.0 / 24);
}

// Orders of three and more leave nothing of these terms.
TEST(ModifiedEnergy, IsTheEnergyForMethodsOfHigherOrder) {
  for (const Method& method : methods()) {
    if (method.order < 3) continue;
    const ModifiedEnergy z = modified_energy(method);
    // Coefficients of 15 digits, products of three in some ten stages.
    EXPECT_NEAR(z.first, 0.0, 1e-14) << method.name;
    EXPECT_NEAR(z.stiffness, 0.0, 1e-14) << method.name;
    EXPECT_NEAR(z.force, 0.0, 1e-14) << method.name;
  }
}

// The greatest swing of the energy, and what is left of it, in a ball that rings, with steps of
// some omega dt.
struct Swing {
  double whole = 0.0, left = 0.0;
  double allowed = 0.0;  // by the ledger for terms left out
};
Swing swing_of(const Method& method, double angle) {
  Scene scene = paper_scene(2);
  scene.walls.clear();
  scene.time.method = method.name;
  scene.time.step = angle / 5221.0;
  Problem problem = make_problem(scene);
  for (std::size_t i = 0; i < problem.initial.size(); ++i) {
    problem.initial.vx[i] = std::sin(4.0 * problem.initial.x[i]);
  }
  const auto stepper = plan_of(scene, problem, "csr").make_stepper();
  const Sample start = measure(problem, problem.initial);
  const double first = start.total() + inspect(problem, problem.initial, start).swing;
  Swing swing;
  const auto every = static_cast<std::int64_t>(std::ceil(1.4 / angle));
  for (int sample = 0; sample < 200; ++sample) {
    stepper->advance(every);
    const State state = stepper->state();
    const Sample now = measure(problem, state);
    const Inspection here = inspect(problem, state, now);
    swing.whole = std::max(swing.whole, std::abs(now.total() - start.total()));
    swing.left = std::max(swing.left, std::abs(now.total() + here.swing - first));
    swing.allowed = left_out(problem, here);
  }
  return swing;
}

// What is left of the swing falls as the third power of the step or faster, where the energy's own
// falls as the first (listing) or the second (leapfrog); of a method of higher order it is the
// energy's own and falls as its order says. 0.5: samples do not meet the greatest swing. omega dt:
// where the sixth order is above rounding, 1e-8 of 2.6e7 erg.
TEST(ModifiedEnergy, SwingsLessByTwoOrders) {
  for (const Method& method : methods()) {
    const double angle = method.order > 2 ? 0.45 * stability_limit(method) : 0.4;
    const Swing coarse = swing_of(method, angle), fine = swing_of(method, 0.5 * angle);
    const int order = std::max(3, method.order);
    EXPECT_GT(std::log2(coarse.left / fine.left), order - 0.5)
        << method.name << " " << coarse.left << " " << fine.left;
    if (method.order < 3) {
      EXPECT_LT(coarse.left, 0.1 * coarse.whole) << method.name;
    }
  }
}

// The ledgers close up to near the edge: the terms that they leave out have factors below 1. 1e-6:
// rounding of 2.6e7 erg.
TEST(ModifiedEnergy, LeavesOutLessThanTheLedgerAllows) {
  for (const Method& method : methods()) {
    for (const double part : {0.1, 0.5, 0.9}) {
      const Swing swing = swing_of(method, part * stability_limit(method));
      EXPECT_LT(swing.left, swing.allowed + 1e-6) << method.name << " " << part;
    }
  }
}

// -------------------------------------------------------------------- broken kernels

// A kernel with its steps or its states tampered with.
class Tampered : public Stepper {
 public:
  using Tamper = std::function<void(Stepper&)>;  // after each step
  Tampered(std::unique_ptr<Stepper> sound, Tamper tamper)
      : sound_(std::move(sound)), tamper_(std::move(tamper)) {}
  void advance(std::int64_t steps) override {
    for (; steps > 0; --steps) {
      sound_->advance(1);
      tamper_(*sound_);
    }
  }
  [[nodiscard]] State state() const override { return sound_->state(); }
  [[nodiscard]] Snapshot save() const override { return sound_->save(); }
  void restore(const Snapshot& snapshot) override { sound_->restore(snapshot); }
  [[nodiscard]] std::int64_t step() const override { return sound_->step(); }

 private:
  std::unique_ptr<Stepper> sound_;
  Tamper tamper_;
};

std::unique_ptr<Stepper> csr(const Problem& problem) {
  PlanRequest request;
  request.kernel = "csr";
  request.threads = 1;
  return make_stepper(problem, request);
}

// One direction of one bond with a constant of elasticity larger by `relative`.
Problem with_uneven_bond(Problem problem, double relative) {
  constexpr std::size_t particle = 56;
  BondList bonds = problem.bonds;
  const auto entry = static_cast<std::size_t>(bonds.start[particle]);
  BondClass uneven = problem.classes[bonds.bond_class[entry]];
  uneven.attraction *= 1.0 + relative;
  bonds.bond_class[entry] = static_cast<std::uint16_t>(problem.classes.size());
  problem.bonds = std::move(bonds);
  problem.classes.push_back(uneven);
  return problem;
}

// The ball high up: no wall is met.
Scene falling() { return paper_scene(5); }

TEST(BrokenKernel, SoundOnesAreNotAccused) {
  for (const char* kernel : {"strict", "csr", "ring"}) {
    const Problem problem = make_problem(falling());
    const auto stepper = plan_of(falling(), problem, kernel).make_stepper();
    const LedgerReport report = watched(problem, *stepper, 20000);
    EXPECT_TRUE(report.closes()) << kernel << "\n" << print(report);
    EXPECT_EQ(report.free_share, 1.0);
    EXPECT_EQ(report.walls, 0.0);
  }
}

TEST(BrokenKernel, AForceNotQuiteAntisymmetricIsSeenInMomentum) {
  const Problem problem = make_problem(falling());
  const auto broken = csr(with_uneven_bond(problem, 1e-9));
  const LedgerReport report = watched(problem, *broken, 20000);
  EXPECT_FALSE(line(report, "momentum x").closes()) << print(report);
  EXPECT_FALSE(line(report, "momentum y").closes()) << print(report);
  EXPECT_FALSE(line(report, "angular momentum").closes()) << print(report);
}

// A kick that turns the ball a little: momentum is kept, angular momentum is not.
TEST(BrokenKernel, AForceOffTheLineIsSeenInAngularMomentum) {
  const Problem problem = make_problem(falling());
  Tampered broken(csr(problem), [](Stepper& stepper) {
    Snapshot s = stepper.save();
    s.state.vy[0] += 1e-9;  // 12 cm apart in x
    s.state.vy[300] -= 1e-9;
    stepper.restore(s);
  });
  const LedgerReport report = watched(problem, broken, 2000, 500);
  EXPECT_TRUE(line(report, "momentum x").closes()) << print(report);
  EXPECT_FALSE(line(report, "angular momentum").closes()) << print(report);
}

// The forces are those of other bonds than the energies.
TEST(BrokenKernel, APotentialThatIsNotTheForcesIsSeenInEnergy) {
  const Problem problem = make_problem(falling());
  Problem other = problem;
  other.classes[2].repulsion *= 1.0 + 1e-5;
  const auto broken = csr(other);
  const LedgerReport report = watched(problem, *broken, 20000);
  EXPECT_FALSE(line(report, "energy without contact").closes()) << print(report);
  EXPECT_TRUE(line(report, "momentum x").closes()) << print(report);
  EXPECT_TRUE(line(report, "momentum y").closes()) << print(report);
}

TEST(BrokenKernel, ADampingIsSeenInEnergy) {
  const Problem problem = make_problem(falling());
  Tampered broken(csr(problem), [](Stepper& stepper) {
    Snapshot s = stepper.save();
    // Towards each other, so that momentum is kept.
    const double pull = 1e-7 * (s.state.vx[5] - s.state.vx[6]);
    s.state.vx[5] -= pull;
    s.state.vx[6] += pull;
    stepper.restore(s);
  });
  const LedgerReport report = watched(problem, broken, 20000);
  EXPECT_FALSE(line(report, "energy without contact").closes()) << print(report);
}

TEST(BrokenKernel, WrongGravityIsSeenInMomentum) {
  const Problem problem = make_problem(falling());
  Problem other = problem;
  other.gravity.y *= 1.0 + 1e-6;
  const auto broken = csr(other);
  const LedgerReport report = watched(problem, *broken, 20000);
  EXPECT_FALSE(line(report, "momentum y").closes()) << print(report);
  EXPECT_TRUE(line(report, "momentum x").closes()) << print(report);
}

constexpr std::size_t lowest = 330;  // of ring 3, straight below the centre: the first at the wall

// A kernel that loses every reflection of that particle.
class Losing final : public Stepper {
 public:
  explicit Losing(const Problem& problem) : walled_(csr(problem)) {
    Problem open = problem;
    open.walls.clear();
    open_ = csr(open);
  }
  void advance(std::int64_t steps) override {
    for (; steps > 0; --steps) {
      open_->restore(walled_->save());
      open_->advance(1);
      walled_->advance(1);
      const State open = open_->save().state;
      Snapshot now = walled_->save();
      now.state.x[lowest] = open.x[lowest];
      now.state.y[lowest] = open.y[lowest];
      now.state.vx[lowest] = open.vx[lowest];
      now.state.vy[lowest] = open.vy[lowest];
      walled_->restore(now);
    }
  }
  [[nodiscard]] State state() const override { return walled_->state(); }
  [[nodiscard]] Snapshot save() const override { return walled_->save(); }
  void restore(const Snapshot& snapshot) override { walled_->restore(snapshot); }
  [[nodiscard]] std::int64_t step() const override { return walled_->step(); }

 private:
  std::unique_ptr<Stepper> walled_, open_;
};

TEST(BrokenKernel, ALostReflectionIsSeenAtTheWalls) {
  const Problem problem = make_problem(at_wall(2));
  Losing broken(problem);
  const LedgerReport report = watched(problem, broken, 12000);
  EXPECT_FALSE(line(report, "walls").closes()) << print(report);
}

// The kernel's rule is not the scene's: seen by the books, reflection by reflection.
TEST(BrokenKernel, AReflectionOtherwiseThanTheRuleIsSeenInTheBooks) {
  const Problem problem = make_problem(at_wall(6));
  const auto broken = [](const Problem& wanted) {
    Problem other = wanted;
    for (Wall& wall : other.walls) wall.beta = -1.0 + 1e-12;
    return csr(other);
  };
  BookingStepper stepper(problem, broken);
  const LedgerReport report = booked(problem, stepper, 12000);
  EXPECT_GT(report.otherwise, 0);
  EXPECT_FALSE(line(report, "walls").closes()) << print(report);
}

TEST(BrokenKernel, ALostReflectionIsSeenInTheBooks) {
  const Problem problem = make_problem(at_wall(2));
  BookingStepper stepper(problem, [](const Problem& wanted) -> std::unique_ptr<Stepper> {
    if (wanted.walls.empty()) return csr(wanted);
    return std::make_unique<Losing>(wanted);
  });
  const LedgerReport report = booked(problem, stepper, 12000);
  EXPECT_GT(report.missed, 0);
  EXPECT_FALSE(line(report, "walls").closes()) << print(report);
}

}  // namespace
}  // namespace bounce
