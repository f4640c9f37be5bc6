#include "verify/accuracy/accuracy.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <numeric>

#include "kernels/model/ball.hpp"
#include "kernels/plan/plan.hpp"
#include "kernels/stepping/threads.hpp"
#include "verify/figures/bounce_gauge.hpp"
#include "verify/vibrations/spectrum.hpp"
#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

const PlanRequest one_thread{"auto", "auto", 1};

// Of a course that others are compared with: the samples before its first contact, and the last of
// them.
void keep_before_contact(Stepper& stepper, const Snapshot& start, std::int64_t steps_a_sample,
                         std::int64_t free_samples, CourseRecord& record) {
  record.free_samples = std::min(record.energy.size(), static_cast<std::size_t>(free_samples));
  if (record.free_samples == 0) return;
  stepper.restore(start);
  stepper.advance((static_cast<std::int64_t>(record.free_samples) - 1) * steps_a_sample);
  record.before = stepper.state();
}

AccuracyRow run(const Scene& scene, const std::optional<State>& initial, const Setting& setting,
                const Sampling& sampling, const CourseRecord& reference) {
  const Problem problem = problem_of(scene, initial, setting, sampling);
  const Plan plan = make_plan(problem, one_thread);
  AccuracyRow row;
  row.setting = setting;
  row.step = problem.step;
  row.steps = sampling.samples * setting.steps_a_sample;
  row.kernel = kernel_name(plan);
  row.evaluations = row.steps * problem.method->evaluations;
  const auto stepper = plan.make_stepper();
  const Snapshot start = stepper->save();
  const bool compares = !reference.energy.empty();
  CourseGauge gauge(problem, compares ? std::optional(reference.free_samples) : std::nullopt);
  const double nominal = sampling.every / static_cast<double>(setting.steps_a_sample);
  BounceGauge figures(problem, nominal, remake(plan));
  bool good = gauge.add(problem.initial);
  figures.look(*stepper);
  while (good && stepper->step() < row.steps) {
    const std::int64_t now = stepper->step(),
                       sample = (now / setting.steps_a_sample + 1) * setting.steps_a_sample;
    stepper->advance(std::min(sample, figures.next(now)) - now);
    if (figures.due(stepper->step()) || stepper->step() == row.steps) figures.look(*stepper);
    if (stepper->step() == sample) good = gauge.add(stepper->state());
  }
  row.record = gauge.result(figures.result());
  if (!compares && good) {
    const double contact = figures.first_contact().value_or(sampling.end() + sampling.every);
    keep_before_contact(*stepper, start, setting.steps_a_sample,
                        static_cast<std::int64_t>(std::ceil(contact / sampling.every)), row.record);
  }
  row.errors = errors_of(row.record, reference);
  return row;
}

}  // namespace

Sampling sampling_of(const Scene& scene, double every) {
  const double samples = std::max(1.0, std::round(scene.time.end / every));
  return {scene.time.end / samples, static_cast<std::int64_t>(samples)};
}

bool worth_locating(const Scene& scene) {
  constexpr std::int64_t most_particles = 5000;
  return ball_size(scene.ball).particles <= most_particles;
}

Problem problem_of(const Scene& scene, const std::optional<State>& initial, const Setting& setting,
                   const Sampling& sampling) {
  Scene chosen = scene;
  chosen.time.method = setting.method;
  chosen.time.step = sampling.every / static_cast<double>(setting.steps_a_sample);
  for (Wall& wall : chosen.walls) wall.contact = setting.contact;
  // When the scene writes is no matter of a course, which may have longer steps.
  chosen.output = OutputSpec();
  chosen.output.monitor_every = chosen.time.step;
  Problem problem = make_problem(chosen, initial);
  if (sampling.exact) problem.step = chosen.time.step;
  return problem;
}

std::string plan_refusal(const Scene& scene, const std::optional<State>& initial,
                         const Setting& setting, const Sampling& sampling) {
  const Problem problem = problem_of(scene, initial, setting, sampling);
  try {
    static_cast<void>(make_plan(problem, one_thread));
  } catch (const PlanError& error) {
    return error.what();
  }
  return {};
}

std::vector<Setting> settings_of(const Scene& scene, const std::optional<State>& initial,
                                 const Setting& kind, const Sampling& sampling,
                                 const StepSweep& sweep) {
  const Problem problem = problem_of(scene, initial, kind, sampling);
  const auto fastest = fastest_vibration(problem, problem.initial);
  if (!fastest || !(fastest->omega > 0.0)) return {};
  const double fewest =
      sampling.every / (sweep.part * stability_limit(*problem.method) / fastest->omega);
  std::vector<Setting> settings;
  const int a_decade = sweep.per_decade * sweep.first_finer;
  const int count = static_cast<int>(std::lround(sweep.decades * a_decade));
  for (int k = 0; k <= count; ++k) {
    if (k > a_decade && k % sweep.first_finer != 0) continue;
    const double n = std::ceil(fewest * std::pow(10.0, static_cast<double>(k) / a_decade));
    Setting setting = kind;
    setting.steps_a_sample = std::max<std::int64_t>(1, std::llround(n));
    if (settings.empty() || !(settings.back() == setting)) settings.push_back(setting);
  }
  return settings;
}

std::optional<std::vector<AccuracyRow>> measure_accuracy(
    const Scene& scene, const std::optional<State>& initial, std::span<const Setting> settings,
    const Sampling& sampling, const CourseRecord& reference, int threads,
    const std::function<bool(std::size_t, const AccuracyRow&)>& done) {
  // The longest first, so that none is left over for one thread at the end.
  std::vector<std::size_t> order(settings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto work = [&](std::size_t i) {
    return settings[i].steps_a_sample * find_method(settings[i].method)->evaluations;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return work(a) > work(b); });
  std::vector<AccuracyRow> rows(settings.size());
  std::atomic<bool> go_on = true;
  std::mutex one_at_a_time;
  parallel_for(order.size(), threads, [&](std::size_t k) {
    if (!go_on) return;
    const std::size_t i = order[k];
    rows[i] = run(scene, initial, settings[i], sampling, reference);
    const std::lock_guard lock(one_at_a_time);
    if (!done(i, rows[i])) go_on = false;
  });
  if (!go_on) return std::nullopt;
  return rows;
}

}  // namespace bounce
