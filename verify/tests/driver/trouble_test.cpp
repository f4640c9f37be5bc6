// Runs that go bad at a known step, in a known way: is that step reported, and that bond?
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include <nlohmann/json.hpp>

#include "driver/run/run_loop.hpp"
#include "driver/run/trouble_text.hpp"
#include "driver/world/shell_word.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The ball at rest at every step, but for what is done to it.
class ScriptedStepper final : public Stepper {
 public:
  using Spoil = std::function<void(std::int64_t step, State& state)>;
  ScriptedStepper(const Problem& problem, Spoil spoil)
      : start_(problem.initial), spoil_(std::move(spoil)) {}
  void advance(std::int64_t steps) override { step_ += steps; }
  [[nodiscard]] State state() const override {
    State state = start_;
    spoil_(step_, state);
    return state;
  }
  [[nodiscard]] Snapshot save() const override { return {start_, false, step_}; }
  void restore(const Snapshot& snapshot) override { step_ = snapshot.step; }
  [[nodiscard]] std::int64_t step() const override { return step_; }

 private:
  State start_;
  Spoil spoil_;
  std::int64_t step_ = 0;
};

// Puts particle i at `ratio` of the bond's length from its neighbour j.
void press(State& state, std::size_t i, std::size_t j, double ratio) {
  state.x[i] = state.x[j] + ratio * (state.x[i] - state.x[j]);
  state.y[i] = state.y[j] + ratio * (state.y[i] - state.y[j]);
}

class TroubleTest : public testing::Test {
 protected:
  // Runs to two seconds, two million steps; the rows of monitor.csv that many steps apart.
  void run(std::int64_t row, ScriptedStepper::Spoil spoil) {
    record_.scene = paper_scene(2);
    record_.scene.time.end = 2.0;
    record_.scene.output = {};
    record_.scene.output.monitor_every = static_cast<double>(row) * record_.scene.time.step;
    ScriptedStepper stepper(problem_, std::move(spoil));
    MarginGauge margin(problem_);
    RunHooks hooks;
    hooks.sample = [&](std::int64_t step, const Sample&, const State& state) {
      margin.add(step, state);
    };
    hooks.frame = [](std::int64_t, const State&) {};
    hooks.listing_frame = hooks.frame;
    hooks.progress = [](std::int64_t) {};
    hooks.stop = [] { return false; };
    record_.result = run_loop(stepper, problem_, Schedule(record_.scene, false), hooks);
    record_.margin = margin.result();
    const RunResult& result = record_.result;
    ASSERT_TRUE(result.trouble);
    record_.trouble_report =
        report_trouble(problem_, *result.trouble, result.start_refused ? nullptr : &result.last,
                       result.refused, record_.margin);
  }
  [[nodiscard]] const RunResult& result() const { return record_.result; }
  [[nodiscard]] const TroubleReport& report() const { return *record_.trouble_report; }

  Problem problem_ = make_problem(paper_scene(2));
  RunRecord record_;
};

TEST_F(TroubleTest, NamesStepParticleBondAndClass) {
  run(10'000, [](std::int64_t step, State& state) {
    if (step >= 12'777) press(state, 129, 130, 0.3);
  });
  EXPECT_EQ(result().status, RunStatus::unstable);
  EXPECT_EQ(result().trouble_step, 12'777);
  EXPECT_EQ(result().step, 12'776);
  EXPECT_EQ(result().looked_from, 10'000);
  EXPECT_EQ(result().trouble->particle, 129);
  EXPECT_EQ(result().trouble->bond_second, 130);
  EXPECT_EQ(report().bond_class, "ring 2-ring 2");
  EXPECT_NEAR(report().refused.ratio, 0.3, 1e-3);
  ASSERT_TRUE(report().before);
  EXPECT_NEAR(report().before->ratio, 1.0, 1e-3);
  const double jump =
      measure(problem_, result().refused).total() - measure(problem_, problem_.initial).total();
  EXPECT_GT(jump, 1e5);
  EXPECT_NEAR(report().energy_jump(), jump, 1e-9 * jump);
  const std::string text = trouble_text(record_);
  for (const char* part :
       {"unstable at step 12777 (t = 0.012777 s): ", "particle 130",
        "bond 130-131, ring 2-ring 2: R/R0 = 0.3, a step before 1",
        "0.002611 of the stable step a step before", "stable would have been: "}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
}

// What the edge was is the spectrum's answer at that state; the proposal is half the least of them,
// and never more than half of the step that failed.
TEST_F(TroubleTest, TellsTheEdgeAndAStableStep) {
  for (double& vx : problem_.initial.vx) vx = 10.0;  // 18000 erg, which may turn up again
  run(10'000, [](std::int64_t step, State& state) {
    if (step >= 10'000) press(state, 29, 30, step < 15'000 ? 0.9 : 0.3);  // stiffer, then too much
  });
  EXPECT_EQ(result().trouble_step, 15'000);
  for (const bool before : {true, false}) {
    const State& state = before ? result().last : result().refused;
    const auto fastest = fastest_vibration(problem_, state);
    ASSERT_TRUE(fastest && fastest->exact);
    const auto& edge = before ? report().before->edge : report().refused.edge;
    ASSERT_TRUE(edge);
    EXPECT_DOUBLE_EQ(edge->stable_step, stability_limit(*problem_.method) / fastest->omega);
    EXPECT_DOUBLE_EQ(edge->part, problem_.step / edge->stable_step);
  }
  EXPECT_LT(report().before->edge->stable_step, 3.6e-4);
  ASSERT_TRUE(report().stable_step);
  EXPECT_DOUBLE_EQ(*report().stable_step, 4.9e-7);  // half of 1e-6 in single precision, two digits
  Problem coarse = problem_;
  coarse.step = 1e-3;
  const TroubleReport other =
      report_trouble(coarse, *result().trouble, &result().last, result().refused, std::nullopt);
  const double edge = report().before->edge->stable_step;
  EXPECT_LE(*other.stable_step, 0.5 * edge);
  EXPECT_GE(*other.stable_step, 0.45 * edge);  // two digits
}

TEST_F(TroubleTest, NamesBondsBetweenRings) {
  run(10'000, [](std::int64_t step, State& state) {
    if (step >= 5) press(state, 250, 129, 0.2);
  });
  EXPECT_EQ(result().trouble_step, 5);
  EXPECT_EQ(result().trouble->bond_first, 129);
  EXPECT_EQ(result().trouble->bond_second, 250);
  EXPECT_EQ(report().bond_class, "ring 2-ring 3");
}

TEST_F(TroubleTest, WhatIsNotANumberIsTroubleAtItsStep) {
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    run(10'000, [bad](std::int64_t step, State& state) {
      if (step >= 4'001) state.vy[250] = bad;
    });
    EXPECT_EQ(result().trouble_step, 4'001);
    EXPECT_EQ(result().step, 4'000);
    EXPECT_TRUE(is_finite(result().last));
    EXPECT_EQ(result().trouble->particle, 250);
    EXPECT_EQ(result().trouble->bond_first, 250);
    EXPECT_FALSE(report().bond_class.empty());
    const auto json = trouble_json(record_);
    EXPECT_EQ(json["step"], 4'001);
    EXPECT_TRUE(json["energy_jump"].is_null());
    EXPECT_TRUE(json["refused"]["energy"].is_null());
    EXPECT_EQ(json["last_good"]["step"], 4'000);
    EXPECT_TRUE(json["stable_step"].is_number());
  }
  run(10'000, [](std::int64_t step, State& state) {
    if (step >= 4'001) state.x[250] = nan;
  });
  EXPECT_FALSE(report().refused.edge);  // a stiffness that is not finite
  EXPECT_NE(trouble_text(record_).find("unknown"), std::string::npos);
  EXPECT_TRUE(trouble_json(record_)["refused"]["part"].is_null());
}

// Energy that swings may be refused, passed and refused again: halving the way would find 7000.
TEST_F(TroubleTest, FindsTheFirstOfSeveral) {
  run(10'000, [](std::int64_t step, State& state) {
    if (step == 1'234 || step >= 7'000) press(state, 7, 8, 0.3);
  });
  EXPECT_EQ(result().trouble_step, 1'234);
  EXPECT_EQ(result().step, 1'233);
  EXPECT_EQ(result().looked_from, 0);
}

TEST_F(TroubleTest, SaysFromWhereItLookedAtEveryStep) {
  run(1'000'000, [](std::int64_t step, State& state) {
    if (step >= 1'654'321) press(state, 7, 8, 0.3);
  });
  EXPECT_EQ(result().trouble_step, 1'654'321);
  EXPECT_EQ(result().step, 1'654'320);
  EXPECT_GT(result().looked_from, 1'654'321 - steps_to_look_at(360));
  EXPECT_LT(result().looked_from, 1'654'321);
  EXPECT_NE(trouble_text(record_).find("was looked at"), std::string::npos);
}

TEST_F(TroubleTest, ARefusedStartHasNoGoodState) {
  run(10'000, [](std::int64_t, State& state) {
    state.x[3] = state.x[4];
    state.y[3] = state.y[4];
  });
  EXPECT_TRUE(result().start_refused);
  EXPECT_EQ(result().trouble_step, 0);
  EXPECT_FALSE(report().before);
  EXPECT_FALSE(report().stable_step);
  EXPECT_NE(trouble_text(record_).find("bond 4-5, ring 1-ring 1"), std::string::npos)
      << trouble_text(record_);
  EXPECT_NE(how_to_go_on(record_, "r").find("no good state"), std::string::npos);
  EXPECT_TRUE(trouble_json(record_)["last_good"].is_null());
}

TEST(ShellWord, IsReadBackAsItWas) {
  EXPECT_EQ(shell_word("runs/example-2"), "runs/example-2");
  EXPECT_EQ(shell_word("my ball.toml"), "'my ball.toml'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("wall[0].alpha=1"), "'wall[0].alpha=1'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace bounce
