#include "verify/accuracy/baseline.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "verify/accuracy/conservative.hpp"
#include "verify/accuracy/gsl_flow.hpp"
#include "verify/figures/bounce_gauge.hpp"
#include "verify/figures/contact_gauge.hpp"
#include "verify/vibrations/spectrum.hpp"

namespace bounce {
namespace {

using Clock = std::chrono::steady_clock;

// A course that takes too long.
struct OutOfTime {};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::string seconds_text(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g s", seconds);
  return text.data();
}

constexpr std::string_view greenspan = "Greenspan, J. Comput. Phys. 56 (1984) 28";
constexpr std::string_view gsl = "GSL odeiv2";

std::vector<double> parameters_of(const Baseline& baseline, const Problem& problem,
                                  const Sampling& sampling, int values) {
  std::vector<double> found;
  if (baseline.adaptive()) {
    for (int k = 0; k < values; ++k) found.push_back(1e-4 * std::pow(10.0, -2 * k));
    return found;
  }
  const auto fastest = fastest_vibration(problem, problem.initial);
  if (!fastest || !(fastest->omega > 0.0)) return found;
  const double edge = 2.0 / fastest->omega;
  for (int k = 0; k < values; ++k) {
    const double step = std::min(4.0 * edge * std::pow(0.5, k), sampling.every);
    const double whole = sampling.every / std::ceil(sampling.every / step * (1.0 - 1e-12));
    if (found.empty() || whole < found.back()) found.push_back(whole);
  }
  return found;
}

std::vector<double> times_of(const Sampling& sampling) {
  std::vector<double> times;
  for (std::int64_t s = 0; s <= sampling.samples; ++s) {
    times.push_back(sampling.every * static_cast<double>(s));
  }
  return times;
}

// One course as it was seen at the output times.
struct Course {
  BaselineWork work;
  std::vector<State> states;
  Bounce bounce;
  double seconds = 0.0;
  std::string unfinished;  // why; "" if it was finished
};

// `looks`: whether figures are found, which takes some time.
Course solve_once(const Baseline& baseline, const Problem& problem, double parameter,
                  std::span<const double> times, double most_seconds,
                  const std::function<void()>& tick, bool looks) {
  Course course;
  course.states.reserve(times.size());
  const auto begin = Clock::now();
  const auto in_time = [&] {
    tick();
    if (seconds_since(begin) > most_seconds) throw OutOfTime{};
  };
  try {
    course.work = baseline.solve(
        problem, parameter, times,
        [&](double, const State& state) { course.states.push_back(state); }, in_time,
        looks ? &course.bounce : nullptr);
  } catch (const OutOfTime&) {
    course.unfinished = "not finished within " + seconds_text(most_seconds);
  } catch (const ReferenceError& error) {
    course.unfinished = error.what();
  }
  course.seconds = seconds_since(begin);
  return course;
}

AccuracyRow row_of(const Baseline& baseline, const Problem& problem, double parameter,
                   const Course& course, std::span<const double> times,
                   const CourseRecord& reference) {
  AccuracyRow row;
  row.setting.method = baseline.name;
  row.setting.contact = problem.walls.empty() ? Contact::resolved : problem.walls.front().contact;
  row.baseline = baseline.contact;
  row.tolerance = baseline.adaptive() ? parameter : 0.0;
  row.steps = course.work.steps;
  row.evaluations = course.work.evaluations;
  row.step = !baseline.adaptive()        ? parameter
             : course.unfinished.empty() ? times.back() / static_cast<double>(row.steps)
                                         : std::nan("");
  row.kernel = "baseline";
  row.note = course.unfinished;
  CourseGauge gauge(problem, reference.free_samples);
  for (const State& state : course.states) {
    if (!gauge.add(state)) break;
  }
  row.record = gauge.result(course.bounce);
  row.record.finite = row.record.finite && course.unfinished.empty();
  row.errors = errors_of(row.record, reference);
  return row;
}

// With a problem of its own.
class OwnConservative final : public Stepper {
 public:
  explicit OwnConservative(Problem problem) : problem_(std::move(problem)), stepper_(problem_) {}
  void advance(std::int64_t steps) override { stepper_.advance(steps); }
  [[nodiscard]] State state() const override { return stepper_.state(); }
  [[nodiscard]] Snapshot save() const override { return stepper_.save(); }
  void restore(const Snapshot& snapshot) override { stepper_.restore(snapshot); }
  [[nodiscard]] std::int64_t step() const override { return stepper_.step(); }
  [[nodiscard]] std::int64_t evaluations() const { return stepper_.evaluations(); }

 private:
  Problem problem_;
  ConservativeStepper stepper_;
};

BaselineWork solve_conservative(const Problem& problem, double step, std::span<const double> times,
                                const ReferenceVisitor& visit, const std::function<void()>& tick,
                                Bounce* figures) {
  if (const std::string why = conservative_refusal(problem); !why.empty()) {
    throw ReferenceError(why);
  }
  Problem own = problem;
  own.step = step;
  OwnConservative stepper(own);
  std::optional<BounceGauge> gauge;
  if (figures != nullptr) {
    gauge.emplace(own, step,
                  [](const Problem& of) { return std::make_unique<OwnConservative>(of); });
    gauge->look(stepper);
  }
  for (const double time : times) {
    tick();
    const std::int64_t output = std::llround(time / step);
    while (stepper.step() < output) {
      const std::int64_t now = stepper.step();
      stepper.advance((gauge ? std::min(output, gauge->next(now)) : output) - now);
      if (gauge && gauge->due(stepper.step())) gauge->look(stepper);
    }
    visit(time, stepper.state());
  }
  const BaselineWork work{stepper.step(), stepper.evaluations()};
  if (gauge) {
    gauge->look(stepper);
    *figures = gauge->result();
  }
  return work;
}

// One of GSL's steppers, contacts located as in a reference.
decltype(Baseline::solve) by_gsl(const gsl_odeiv2_step_type* type) {
  return [type](const Problem& problem, double tolerance, std::span<const double> times,
                const ReferenceVisitor& visit, const std::function<void()>& tick, Bounce* figures) {
    GslFlow flow(problem, type, tolerance, tick);
    // Not looked at again: a multistep method would begin afresh.
    ContactGauge gauge(problem, false);
    const ReferenceRun run = ContactSolver<GslFlow>(problem, flow)
                                 .run(times, visit, figures != nullptr ? &gauge : nullptr);
    if (figures != nullptr) *figures = gauge.result();
    return BaselineWork{run.steps, run.evaluations};
  };
}

}  // namespace

std::span<const Baseline> baselines() {
  static const std::vector<Baseline> all{
      {"conservative", greenspan, BaselineContact::listing, solve_conservative},
      {"conservative", greenspan, BaselineContact::resolved, solve_conservative},
      {"gsl-rkf45", gsl, BaselineContact::located, by_gsl(gsl_odeiv2_step_rkf45)},
      {"gsl-rk8pd", gsl, BaselineContact::located, by_gsl(gsl_odeiv2_step_rk8pd)},
      {"gsl-msadams", gsl, BaselineContact::located, by_gsl(gsl_odeiv2_step_msadams)},
      {"gsl-msbdf", gsl, BaselineContact::located, by_gsl(gsl_odeiv2_step_msbdf)},
      {"gsl-bsimp", gsl, BaselineContact::located, by_gsl(gsl_odeiv2_step_bsimp)},
  };
  return all;
}

bool is_baseline(std::string_view name) {
  const auto all = baselines();
  return std::any_of(all.begin(), all.end(), [&](const Baseline& b) { return b.name == name; });
}

std::vector<BaselineRow> measure_baseline(const Baseline& baseline, const Scene& scene,
                                          const std::optional<State>& initial,
                                          const Sampling& sampling, const CourseRecord& reference,
                                          const BaselineSweep& sweep,
                                          const std::function<void()>& tick) {
  const Contact contact =
      baseline.contact == BaselineContact::listing ? Contact::listing : Contact::resolved;
  const Problem problem = problem_of(scene, initial, {"leapfrog", contact, 1}, sampling);
  const std::vector<double> times = times_of(sampling);
  std::vector<BaselineRow> rows;
  const auto parameters = parameters_of(baseline, problem, sampling, sweep.values);
  for (const double parameter : parameters) {
    const auto once = [&](bool looks) {
      return solve_once(baseline, problem, parameter, times, sweep.most_seconds, tick, looks);
    };
    const Course course = once(true);
    // Timed without looks, but for a course that takes long, of which they are a small part.
    const bool is_short = course.unfinished.empty() && course.seconds < 10.0 * sweep.least_seconds;
    std::vector<double> seconds;
    for (double spent = 0.0; is_short && spent < sweep.least_seconds; spent += seconds.back()) {
      seconds.push_back(once(false).seconds);
    }
    if (seconds.empty()) seconds.push_back(course.seconds);
    std::nth_element(seconds.begin(), seconds.begin() + seconds.size() / 2, seconds.end());
    rows.push_back({row_of(baseline, problem, parameter, course, times, reference),
                    seconds[seconds.size() / 2]});
    if (course.unfinished.empty()) continue;
    // A smaller parameter takes longer.
    if (rows.size() < parameters.size()) rows.back().row.note += "; the rest was not begun";
    break;
  }
  return rows;
}

}  // namespace bounce
