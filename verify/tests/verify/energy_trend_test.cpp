// In free flight no method's energy has a trend, with the paper's step or a large one. Short
// flights here, as long as that in which a damping of one part in 10^12 is seen; 10^7 evaluations of the force for each take a minute or two: set BOUNCE_LONG to fly
// them.
#include "verify/stability/energy_trend.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "kernels/plan/plan.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/vibrations/spectrum.hpp"
#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

constexpr std::int64_t short_flight = 50'000;  // evaluations of the force

std::int64_t flight(const Method& method) {
  const std::int64_t evaluations =
      std::getenv("BOUNCE_LONG") != nullptr ? 10'000'000 : short_flight;
  return evaluations / method.evaluations;
}

Problem in_the_air(int example, const Method& method) {
  Scene scene = paper_scene(example);
  scene.walls.clear();
  scene.time.method = method.name;
  return make_problem(scene);
}

TEST(EnergyTrend, NoMethodHasOne) {
  for (const Method& method : methods()) {
    for (const int example : {2, 5}) {
      for (const char* kernel : {"csr", "ring"}) {
        const Problem problem = in_the_air(example, method);
        PlanRequest request;
        request.kernel = kernel;
        const auto stepper = make_stepper(problem, request);
        const EnergyTrend trend = free_flight_trend(problem, *stepper, flight(method));
        EXPECT_FALSE(trend.any()) << method.name << " " << example << " " << kernel << ": slope "
                                  << trend.slope;
        EXPECT_TRUE(trend.ledger.closes());
        if (std::getenv("BOUNCE_LONG") != nullptr) {
          std::printf("%s, Example %d, %s: slope %.2e +- %.2e erg/step, rounding %.2e\n",
                      std::string(method.name).c_str(), example, kernel, trend.slope,
                      trend.half_width, trend.rounding);
          for (const LedgerLine& line : trend.ledger.lines) {
            std::printf("  %s: %.2e, walk %.2e, allowed %.2e %s\n", line.name.c_str(),
                        line.residual, line.likely, line.allowed, line.unit.c_str());
          }
        }
      }
    }
  }
}

// With a quarter of the stable step the truncation error is no longer lost in rounding: it may come
// and go, but not grow.
TEST(EnergyTrend, NoMethodHasOneWithALargeStep) {
  for (const Method& method : methods()) {
    Problem problem = in_the_air(5, method);
    const double omega = fastest_vibration(problem, problem.initial).value().omega;
    problem.step = 0.25 * stable_step(method, omega);
    const auto stepper = make_stepper(problem);
    const EnergyTrend trend = free_flight_trend(problem, *stepper, flight(method));
    EXPECT_FALSE(trend.any()) << method.name << ": slope " << trend.slope << " +- "
                              << trend.half_width << ", rounding " << trend.rounding;
    EXPECT_TRUE(trend.ledger.closes()) << method.name;
  }
}

// Multiplies all velocities by a factor after each step.
class Damped final : public Stepper {
 public:
  Damped(std::unique_ptr<Stepper> sound, double factor)
      : sound_(std::move(sound)), factor_(factor) {}
  void advance(std::int64_t steps) override {
    for (; steps > 0; --steps) {
      sound_->advance(1);
      Snapshot s = sound_->save();
      for (double& v : s.state.vx) v *= factor_;
      sound_->restore(s);
    }
  }
  [[nodiscard]] State state() const override { return sound_->state(); }
  [[nodiscard]] Snapshot save() const override { return sound_->save(); }
  void restore(const Snapshot& snapshot) override { sound_->restore(snapshot); }
  [[nodiscard]] std::int64_t step() const override { return sound_->step(); }

 private:
  std::unique_ptr<Stepper> sound_;
  double factor_;
};

TEST(EnergyTrend, SeesADampingOfOnePartInTenToTheTwelve) {
  const Problem problem = in_the_air(5, *find_method("listing"));
  Damped broken(make_stepper(problem), 1.0 - 1e-12);
  const EnergyTrend trend = free_flight_trend(problem, broken, short_flight, 16, 16);
  // 360 particles at 4 cm/s have 2880 erg.
  EXPECT_NEAR(trend.slope, -2.0 * 1e-12 * 2880.0, 1e-10);
  EXPECT_TRUE(trend.any());
}

TEST(EnergyTrend, RefusesWallsAndTooFewSteps) {
  const Problem problem = make_problem(paper_scene(2));
  const auto stepper = make_stepper(problem);
  EXPECT_THROW(free_flight_trend(problem, *stepper, 1000), std::invalid_argument);
  const Problem open = in_the_air(2, *find_method("listing"));
  EXPECT_THROW(free_flight_trend(open, *stepper, 10), std::invalid_argument);
  EXPECT_THROW(free_flight_trend(open, *stepper, 1000, 2), std::invalid_argument);
}

}  // namespace
}  // namespace bounce
