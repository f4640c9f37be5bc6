// Error against cost: what a course's gauge sees, that errors fall as they should, and the choice
// of the cheapest setting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "driver/accuracy/accuracy_table.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/accuracy/accuracy.hpp"
#include "verify/accuracy/advice.hpp"
#include "verify/accuracy/baseline.hpp"
#include "verify/accuracy/course_timing.hpp"
#include "verify/accuracy/reference_pair.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan = std::nan("");

// Example 1's ball, 0.002 cm above the floor at the speed of its fall: contact within 3 ms.
Scene impact_scene() {
  Scene scene;
  scene.law.elasticity = 1000.0;
  scene.ball.centre.y = 7.002;
  scene.ball.velocity = {0.0, -0.77};
  scene.walls = {Wall{}};
  scene.time.end = 0.4;
  return scene;
}

constexpr Sampling sampling{0.01, 40};

const CourseRecord& impact_reference() {
  static const CourseRecord record = [] {
    const Problem problem =
        problem_of(impact_scene(), {}, {"listing", Contact::resolved, 1}, sampling);
    std::vector<double> times;
    for (int i = 0; i <= sampling.samples; ++i) times.push_back(sampling.every * i);
    const ReferencePair pair = solve_both(problem, times, {});
    CourseGauge gauge(problem, pair.last_before_contact() + 1);
    for (const State& state : pair.fixed.states) gauge.add(state);
    return gauge.result(pair.fixed.bounce);
  }();
  return record;
}

std::vector<AccuracyRow> rows_of(const Scene& scene, const std::vector<Setting>& settings,
                                 const CourseRecord& reference, int threads = 2) {
  return measure_accuracy(scene, {}, settings, sampling, reference, threads,
                          [](std::size_t, const AccuracyRow&) { return true; })
      .value();
}

TEST(CourseGauge, NothingIsKnownOfACourseThatIsNotFinite) {
  const Problem problem = make_problem(impact_scene());
  CourseGauge good(problem), bad(problem, 1);
  State state = problem.initial;
  good.add(state);
  good.add(state);
  bad.add(state);
  state.vx[7] = nan;
  EXPECT_FALSE(bad.add(state));
  const CourseErrors errors = errors_of(bad.result({}), good.result({}));
  EXPECT_EQ(errors.position, infinity);
  EXPECT_EQ(errors.energy, infinity);
  for (const ObservableName& each : observable_names) {
    EXPECT_EQ(errors.observables.*each.value, infinity) << each.name;
  }
}

TEST(AccuracySettings, TheFirstDecadeMayBeFiner) {
  const Setting kind{"leapfrog", Contact::resolved, 1};
  Scene scene = impact_scene();
  scene.law.elasticity = 1e9;
  const auto steps = [&](const StepSweep& sweep) {
    std::vector<double> all;
    for (const Setting& each : settings_of(scene, {}, kind, sampling, sweep)) {
      all.push_back(static_cast<double>(each.steps_a_sample));
    }
    return all;
  };
  const std::vector<double> plain = steps({0.9, 2.0, 3}), finer = steps({0.9, 2.0, 3, 4});
  ASSERT_EQ(plain.size(), 7U);
  ASSERT_EQ(finer.size(), 13U + 3U);
  for (const double step : plain) EXPECT_EQ(std::count(finer.begin(), finer.end(), step), 1);
  // Whole numbers, the smallest some 7000.
  for (std::size_t k = 1; k < finer.size(); ++k) {
    EXPECT_NEAR(std::log10(finer[k] / finer[k - 1]), k < 13 ? 1.0 / 12.0 : 1.0 / 3.0, 1e-3) << k;
  }
}

TEST(CourseErrorsTest, TheLargerOfTwoIsOfEachAndKeepsWhatIsNotKnown) {
  CourseErrors a{{}, 1.0, 2.0, nan}, b{{}, 3.0, nan, 1.0};
  for (const ObservableName& each : observable_names) {
    a.observables.*each.value = 1.0;
    b.observables.*each.value = 2.0;
  }
  a.observables.rebound = 5.0;
  b.observables.speed = nan;
  for (const CourseErrors& both : {larger_of(a, b), larger_of(b, a)}) {
    EXPECT_EQ(both.position, 3.0);
    EXPECT_TRUE(std::isnan(both.energy_free));
    EXPECT_TRUE(std::isnan(both.energy));
    EXPECT_EQ(both.observables.rebound, 5.0);
    EXPECT_EQ(both.observables.height, 2.0);
    EXPECT_TRUE(std::isnan(both.observables.speed));
  }
}

// The paper's contact moves the energy that the wall takes by some per cent at any of these steps;
// the resolved one is right to 1e-3 of it at the largest, and better with the square of the step
// (a tenth of the step: 100; 20 is asked for, as contacts fall now here, now there within a step).
TEST(Accuracy, ResolvedContactConverges) {
  const Scene scene = impact_scene();
  const CourseRecord& reference = impact_reference();
  const double lost = reference.observables.lost;
  ASSERT_GT(lost, 1.0);
  const std::vector<AccuracyRow> rows = rows_of(scene,
                                                {{"leapfrog", Contact::listing, 10},
                                                 {"leapfrog", Contact::listing, 100},
                                                 {"leapfrog", Contact::resolved, 10},
                                                 {"leapfrog", Contact::resolved, 100},
                                                 {"leapfrog", Contact::resolved, 1000}},
                                                reference);
  const auto error = [&](std::size_t i) { return rows[i].errors.observables.lost / lost; };
  EXPECT_GT(error(0), 5 * error(2));
  EXPECT_GT(error(1), 50 * error(3));
  EXPECT_GT(error(2), 20 * error(3));
  EXPECT_LT(error(4), error(3));
  EXPECT_LT(rows[4].errors.observables.height, 1e-8);  // cm, of 0.3 that it moved
  EXPECT_LT(rows[4].errors.observables.flattening, 1e-7);
}

TEST(Accuracy, IsTheSameForAnyThreads) {
  const Scene scene = impact_scene();
  const CourseRecord& reference = impact_reference();
  const std::vector<Setting> settings{{"listing", Contact::listing, 20},
                                      {"leapfrog", Contact::resolved, 50},
                                      {"listing", Contact::resolved, 7}};
  const auto one = rows_of(scene, settings, reference, 1);
  const auto three = rows_of(scene, settings, reference, 3);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    EXPECT_EQ(one[i].setting, settings[i]);
    EXPECT_EQ(one[i].errors.position, three[i].errors.position);
    EXPECT_EQ(one[i].record.energy, three[i].record.energy);
    EXPECT_EQ(one[i].steps, 40 * settings[i].steps_a_sample);
  }
}

// Beyond the edge, whether its numbers still are finite at the end or not.
TEST(Accuracy, AnUnstableCourseIsFarOff) {
  const auto rows = rows_of(impact_scene(),
                            {{"leapfrog", Contact::resolved, 1}, {"listing", Contact::listing, 4}},
                            impact_reference());
  for (const AccuracyRow& row : rows) EXPECT_GT(row.errors.observables.height, 100.0) << row.step;
}

TEST(Accuracy, StopsWhenAsked) {
  const Scene scene = impact_scene();
  const std::vector<Setting> settings{{"listing", Contact::listing, 20},
                                      {"listing", Contact::listing, 30}};
  EXPECT_FALSE(measure_accuracy(scene, {}, settings, sampling, impact_reference(), 1,
                                [](std::size_t, const AccuracyRow&) { return false; })
                   .has_value());
}

TEST(Accuracy, SettingsCoverTheDecades) {
  const auto settings =
      settings_of(impact_scene(), {}, {"leapfrog", Contact::resolved, 1}, sampling, {0.9, 3.0, 3});
  ASSERT_EQ(settings.size(), 10U);
  // 0.9 of 1.532e-3 s: 7.2515 steps in 0.01 s, so 8.
  EXPECT_EQ(settings.front().steps_a_sample, 8);
  EXPECT_EQ(settings.back().steps_a_sample, 7252);
}

TEST(Accuracy, SaysWhatNoKernelCanRun) {
  Scene corner = impact_scene();
  corner.walls.front().alpha = 1.0;
  corner.walls.push_back({{1.0, 0.0}, -20.0, 1.0, 0.0});
  const auto refusal = [](const Scene& scene, Contact contact) {
    return plan_refusal(scene, {}, {"leapfrog", contact, 10}, sampling);
  };
  EXPECT_EQ(refusal(impact_scene(), Contact::located), "");
  EXPECT_EQ(refusal(corner, Contact::resolved), "");
  EXPECT_EQ(refusal(corner, Contact::listing), "");
  EXPECT_NE(refusal(corner, Contact::located).find("slides along one wall"), std::string::npos);
}

// A kind none of whose courses stayed finite has no time; that of another contact does not give it
// one.
TEST(CourseTiming, KeepsContactsApart) {
  std::vector<AccuracyRow> rows(2);
  rows[0].setting = {"leapfrog", Contact::listing, 100};
  rows[0].record.finite = false;
  rows[1].setting = {"leapfrog", Contact::resolved, 100};
  rows[1].record.observables.contact = 0.1;
  rows[1].steps = 4000;
  const CourseTimes times = time_courses(impact_scene(), {}, sampling, rows, false, 1);
  ASSERT_EQ(times.rows.size(), 2U);
  EXPECT_TRUE(std::isnan(times.rows[0]));
  EXPECT_GT(times.rows[1], 0.0);
}

// ------------------------------------------------------------------------ advice

// Three courses for the reference, and six methods at nine steps, with a wall at five more by
// located contact.
TEST(Advice, TriesLocatedContactWhereThereIsAWall) {
  Scene scene = impact_scene();
  scene.time.end = 0.1;
  const auto courses = [](const Scene& of) {
    const auto advice = advise({of, {}, 1e-3, "height", 2});
    return advice ? advice->courses : 0;
  };
  const std::size_t walled = courses(scene);
  scene.walls.clear();
  EXPECT_EQ(walled, courses(scene) + std::size_t{6} * 5);
}

// A setting may be told from the pilot's reference if that is known three times as well as asked. A
// ball that bounces elastically again and again makes roundings large: no pilot knows it much
// better than another, and the finest settings come as near as any.
TEST(Advice, IsGivenWhereThePilotKnowsThreeTimesBetter) {
  Scene scene;
  scene.ball.radii = {1.0, 2.0};
  scene.ball.per_ring = 12;
  scene.ball.centre.y = 3.0;
  scene.ball.rounding = Rounding::none;
  scene.law.elasticity = 1000.0;
  scene.law.rest = Rest::geometry;
  scene.gravity.y = -98.0;
  scene.walls = {Wall{{0.0, 1.0}, 0.0, 1.0, -1.0}};
  scene.time.end = 1.0;
  scene.constants = Constants::double_precision;
  scene.output.monitor_every = 0.05;
  const auto ask = [&](double error) { return advise({scene, {}, error, "height", 2}); };
  const auto lax = ask(1.0);
  ASSERT_TRUE(lax);
  for (const double part : {1.2, 2.6, 6.0}) {
    const double asked = part * lax->known_to;
    try {
      const auto advice = ask(asked);
      ASSERT_TRUE(advice);
      EXPECT_LE(3.0 * advice->known_to, asked) << part;
      EXPECT_LE(advice->error, asked) << part;
      EXPECT_GE(advice->error, advice->known_to) << part;
    } catch (const NoAdvice& none) {
      EXPECT_EQ(none.why, NoAdvice::Why::not_reached);
      EXPECT_GT(none.smallest, asked) << part;
    }
  }
}

// ------------------------------------------------------------------------ baselines

std::vector<BaselineRow> sweep_of(const Baseline& baseline, const BaselineSweep& sweep) {
  return measure_baseline(baseline, impact_scene(), {}, sampling, impact_reference(), sweep, [] {});
}

bool is_stiff(const Baseline& baseline) {
  return baseline.name == "gsl-msbdf" || baseline.name == "gsl-bsimp";
}

// Two values of the parameter apart: steps a quarter, of order 2 at best and 1 at the contacts; or
// tolerances a hundredth of a hundredth. A factor 2 is what order 1 keeps of 4 where contacts fall
// now here, now there within a step; the adaptive ones gain 1e4 and keep 100 of it.
TEST(Baseline, ComesNearerTheReference) {
  for (const Baseline& baseline : baselines()) {
    if (baseline.contact == BaselineContact::listing) continue;  // that converges too slowly
    if (is_stiff(baseline)) continue;                            // baseline_test.cpp has these
    const auto rows = sweep_of(baseline, {3, 60.0, 0.0});
    ASSERT_EQ(rows.size(), 3U) << baseline.name;
    const double first = rows[0].row.errors.observables.height;
    const double last = rows[2].row.errors.observables.height;
    EXPECT_LT(last * (baseline.adaptive() ? 100.0 : 2.0), first) << baseline.name;
    for (const BaselineRow& each : rows) {
      EXPECT_GT(each.row.evaluations, each.row.steps) << baseline.name;
      EXPECT_GT(each.seconds, 0.0);
      EXPECT_EQ(each.row.tolerance > 0.0, baseline.adaptive());
    }
  }
}

TEST(Baseline, ACourseThatTakesTooLongHasNoResult) {
  for (const Baseline& baseline : baselines()) {
    const auto rows = sweep_of(baseline, {3, 0.0, 0.0});
    ASSERT_EQ(rows.size(), 1U) << baseline.name;
    EXPECT_EQ(rows[0].row.errors.observables.height, infinity) << baseline.name;
    EXPECT_EQ(rows[0].row.note, "not finished within 0 s; the rest was not begun") << baseline.name;
  }
}

// ------------------------------------------------------------------------ the cheapest as good

TimedRow timed(double error, double seconds) {
  TimedRow row;
  row.seconds = seconds;
  for (const ObservableName& each : observable_names) {
    row.row.errors.observables.*each.value = error;
  }
  return row;
}

CourseErrors bar_of(double size) {
  CourseErrors bar;
  for (const ObservableName& each : observable_names) bar.observables.*each.value = size;
  return bar;
}

TEST(CheapestAsGood, MustBeAsGoodInAll) {
  std::vector<TimedRow> rows{timed(1e-3, 100.0), timed(1e-3, 7.0), timed(1e-4, 5.0),
                             timed(2e-3, 1.0), timed(1e-5, 2.0)};
  rows[4].row.errors.observables.speed = 1.1e-3;
  EXPECT_EQ(cheapest_as_good(rows, {0, 100.0}, bar_of(0.0)), 2U);
  rows[4].row.errors.observables.speed = nan;
  EXPECT_EQ(cheapest_as_good(rows, {0, 100.0}, bar_of(0.0)), 2U);
  rows[4].row.errors.observables.speed = 1e-3;
  EXPECT_EQ(cheapest_as_good(rows, {0, 100.0}, bar_of(0.0)), 4U);
  EXPECT_EQ(cheapest_as_good(rows, {}, bar_of(0.0)), std::nullopt);
  // A run time that is not known is no cheap one, and what went astray is no measure.
  rows[4].seconds = nan;
  EXPECT_EQ(cheapest_as_good(rows, {0, 100.0}, bar_of(0.0)), 2U);
  rows[0].row.errors = bar_of(infinity);
  EXPECT_EQ(cheapest_as_good(rows, {0, 100.0}, bar_of(0.0)), std::nullopt);
}

// Below the reference's own error bar nothing can be told apart.
TEST(CheapestAsGood, ClaimsNothingBelowTheBar) {
  const std::vector<TimedRow> rows{timed(1e-6, 100.0), timed(5e-6, 1.0), timed(2e-5, 0.5)};
  EXPECT_EQ(cheapest_as_good(rows, {0, 100.0}, bar_of(1e-5)), 1U);
  EXPECT_EQ(cheapest_as_good(rows, {0, 100.0}, bar_of(1e-7)), 0U);
}

TEST(AccuracyCsv, QuotesWhyACourseWasNotFinished) {
  std::vector<TimedRow> rows{timed(infinity, 1.0), timed(1e-3, 1.0)};
  rows[0].row.note = "too long, says \"it\"";
  const std::string csv = accuracy_csv(rows, {}, bar_of(0.0));
  EXPECT_NE(csv.find(",\"too long, says \"\"it\"\"\"\n"), std::string::npos) << csv;
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  std::stringstream lines(csv);
  std::string head, reference, noted, plain;
  std::getline(lines, head);
  std::getline(lines, reference);
  std::getline(lines, noted);
  std::getline(lines, plain);
  EXPECT_EQ(commas(reference), commas(head)) << reference;
  EXPECT_EQ(commas(noted), commas(head) + 1) << noted;  // the text's own
  EXPECT_EQ(commas(plain), commas(head)) << plain;
  EXPECT_NE(accuracy_table(rows, {}, {}, bar_of(0.0)).find("(too long, says"), std::string::npos);
}

// Beyond the stable step a ball flies apart, and where it is then takes another time.
TEST(CourseTiming, ALocatedCourseThatHasBlownUpTellsNothing) {
  const Sampling short_course{0.01, 4};
  const Setting kind{"leapfrog", Contact::located, 1};
  const auto seconds = [&](const std::vector<Setting>& settings) {
    const auto rows = measure_accuracy(impact_scene(), {}, settings, short_course, {}, 1,
                                       [](std::size_t, const AccuracyRow&) { return true; });
    for (const AccuracyRow& row : *rows) EXPECT_TRUE(row.record.finite);
    return time_courses(impact_scene(), {}, short_course, *rows, false, 1).rows;
  };
  Setting beyond = kind, stable = kind;
  beyond.steps_a_sample = 6;  // 1.7 ms; stable are 1.5
  stable.steps_a_sample = 10;
  EXPECT_TRUE(std::isnan(seconds({beyond})[0]));
  EXPECT_GT(seconds({beyond, stable})[0], 0.0);
}

TEST(StepTiming, LeavesTheSteppersAsTheyWere) {
  const Problem problem = make_problem(impact_scene());
  const auto a = make_stepper(problem, {"ring", "auto", 1});
  const auto b = make_stepper(problem, {"csr", "auto", 1});
  a->advance(10);
  const State before = a->state();
  const std::vector<Stepper*> all{a.get(), b.get()};
  const std::vector<double> seconds = time_steps(all, 3, 1e-5);
  ASSERT_EQ(seconds.size(), 2U);
  for (const double s : seconds) EXPECT_TRUE(s > 0.0 && s < 1.0) << s;
  EXPECT_TRUE(same_state(a->state(), before));
  EXPECT_EQ(a->step(), 10);
}

}  // namespace
}  // namespace bounce
