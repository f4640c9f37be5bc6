#include "driver/scene/step_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "kernels/model/method.hpp"
#include "verify/stability/bounce_run.hpp"
#include "verify/vibrations/stability_limit.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {
namespace {

// Two digits, and more where they tell a step below the edge from one beyond it.
std::string part_text(double part) {
  return std::abs(part - 1.0) < 0.1 ? fmt::format("{:.4g}", part) : fmt::format("{:.2g}", part);
}

std::string source_of(bool exact) { return exact ? "" : ", by a bound: some per cent too careful"; }

// What could pass through something within a step.
void refuse_long_strides(const SceneFile& file, const Problem& problem) {
  Sample start = measure(problem, problem.initial);
  start.approach = std::max(start.approach, meeting_speed(problem));
  const Stride stride = stride_of(problem, start);
  const double part = std::max(stride.bond, stride.wall);
  if (stride.bond <= 1.0 && stride.wall <= 1.0) return;
  throw file.explain(SceneError(
      "time.step", fmt::format("{}", file.scene().time.step),
      fmt::format(
          "at most {:.2g} s: {} moves by {:.3g} times the distance between neighbours in a "
          "step, and could pass through unnoticed; --force runs it all the same",
          problem.step / part,
          stride.bond > stride.wall
              ? "one end of a bond"
              : fmt::format("a particle that comes to a wall at {:.3g} cm/s", start.approach),
          part)));
}

}  // namespace

std::optional<StepCheck> check_step(const Problem& problem) {
  const auto fastest = fastest_vibration(problem, problem.initial);
  if (!fastest) return std::nullopt;
  return StepCheck{*fastest, stable_step(*problem.method, fastest->omega),
                   part_of_stable_step(problem, fastest->omega)};
}

void refuse_unstable_step(const SceneFile& file, const Problem& problem,
                          const std::optional<StepCheck>& check) {
  refuse_long_strides(file, problem);
  if (!check) {
    throw file.explain(
        SceneError("initial state", "a bond without a finite stiffness",
                   "particles apart from each other (--force runs it all the same)"));
  }
  if (check->part <= 1.0) return;
  throw file.explain(SceneError(
      "time.step", fmt::format("{}", file.scene().time.step),
      fmt::format(
          "at most {:.4g} s, the stable step of method {} at this start (omega_max = {:.4g} "
          "1/s{}); --force runs it all the same",
          check->stable_step, problem.method->name, check->fastest.omega,
          source_of(check->fastest.exact))));
}

std::string describe(const StepCheck& check, const Problem& problem) {
  return fmt::format(
      "time step: {} of the stable step of {} at the start, {:.4g} s (omega_max = "
      "{:.4g} 1/s{})",
      part_text(check.part), problem.method->name, check.stable_step, check.fastest.omega,
      source_of(check.fastest.exact));
}

std::string warning_of(const StepCheck& check, const Scene& scene) {
  if (check.part <= part_to_warn_of) return "";
  return fmt::format("time.step = {} is {} of the stable step {:.4g} s{}", scene.time.step,
                     part_text(check.part), check.stable_step,
                     check.part > 1.0
                         ? "; it is run all the same (--force)"
                         : "; in an impact, which presses bonds, it may become unstable");
}

std::string warning_of_lost_motion(const Problem& problem, const Scene& scene) {
  double place = 0.0;
  for (std::size_t i = 0; i < problem.initial.size(); ++i) {
    place = std::max({place, std::abs(problem.initial.x[i]), std::abs(problem.initial.y[i])});
  }
  const double last_place = std::nextafter(place, std::numeric_limits<double>::infinity()) - place;
  const double lost = 0.5 * last_place / problem.step;
  if (lost * scene.time.end <= lost_motion_to_warn_of) return "";
  return fmt::format(
      "positions of {:.3g} cm are rounded to {:.2g} cm: what is slower than {:.2g} cm/s does not "
      "move in a step of {} s, and {:.2g} cm may get lost until {} s",
      place, last_place, lost, scene.time.step, lost * scene.time.end, scene.time.end);
}

std::string describe(const Margin& margin, double time) {
  std::string text = fmt::format("{:.3g} at t = {:.4g} s (bond {}-{} at R/R0 = {:.3g}", margin.part,
                                 time, margin.first + 1, margin.second + 1, margin.ratio);
  // Said only where it shows in the digits.
  if (fmt::format("{:.3g}", margin.at_most) != fmt::format("{:.3g}", margin.part)) {
    text += fmt::format("; no row of monitor.csv above {:.3g}", margin.at_most);
  }
  return text + (margin.exact ? ")" : "; by a bound)");
}

}  // namespace bounce
