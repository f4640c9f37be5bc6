// The ledgers notice the kernel that breaks them. The broken kernels are real ones whose results or
// problems are tampered with: a force that differs a little between a bond's two ends, a potential
// that is not that of the force, a reflection that is left out, or done otherwise.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/verify/ledger_runs.hpp"
#include "verify/watch/booking_stepper.hpp"
#include "verify/watch/ledger.hpp"

namespace bounce {
namespace {

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
