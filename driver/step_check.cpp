#include "driver/step_check.hpp"

#include <fmt/format.h>

#include "kernels/stepping/method.hpp"
#include "verify/stability_limit.hpp"

namespace bounce {
namespace {

std::string source_of(bool exact) { return exact ? "" : ", by a bound: some per cent too careful"; }

}  // namespace

std::optional<StepCheck> check_step(const Problem& problem) {
  const auto fastest = fastest_vibration(problem, problem.initial);
  if (!fastest) return std::nullopt;
  return StepCheck{*fastest, stable_step(*problem.method, fastest->omega),
                   part_of_stable_step(problem, fastest->omega)};
}

void refuse_unstable_step(const SceneFile& file, const Problem& problem,
                          const std::optional<StepCheck>& check) {
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
      "time step: {:.2g} of the stable step of {} at the start, {:.4g} s (omega_max = "
      "{:.4g} 1/s{})",
      check.part, problem.method->name, check.stable_step, check.fastest.omega,
      source_of(check.fastest.exact));
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
