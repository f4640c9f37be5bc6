#include "verify/stability/trials.hpp"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>

#include "kernels/contact/located.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

// Of any kind of scene: one after the other, each on one thread.
bool run_alone(const Problem& problem, const Plan& plan, std::int64_t steps,
               std::int64_t look_every, const std::function<bool(const State&)>& is_good) {
  const auto stepper = make_stepper(problem, plan);
  for (std::int64_t done = 0; done < steps;) {
    const std::int64_t next = std::min(look_every, steps - done);
    stepper->advance(next);
    done += next;
    const State state = stepper->state();
    if (!is_finite(state) || !is_good(state)) return false;
  }
  return true;
}

std::vector<bool> run_each_alone(std::span<const Problem> problems,
                                 std::span<const std::int64_t> steps, std::int64_t look_every,
                                 const IsGood& is_good, const TrialOptions& options) {
  PlanRequest request{"auto", options.vector, 1};
  std::vector<Plan> plans;
  for (const Problem& problem : problems) plans.push_back(make_plan(problem, request));
  std::vector<char> good(problems.size());  // not bool: written side by side
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1) \
    num_threads(options.threads == 0 ? omp_get_num_procs() : options.threads)
  for (std::size_t i = 0; i < problems.size(); ++i) {
    try {
      const auto look = [&](const State& state) { return is_good(i, state); };
      good[i] = run_alone(problems[i], plans[i], steps[i], look_every, look) ? 1 : 0;
    } catch (...) {
#pragma omp critical
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return {good.begin(), good.end()};
}

}  // namespace

std::vector<bool> run_trials(std::span<const Problem> problems, std::span<const std::int64_t> steps,
                             std::int64_t look_every, const IsGood& look,
                             const TrialOptions& options) {
  check_threads(options.threads);
  if (problems.empty()) return {};
  const IsGood is_good = [&](std::size_t i, const State& state) {
    return !(options.stop && options.stop()) && look(i, state);
  };
  std::vector<Problem> resolved;
  if (std::any_of(problems.begin(), problems.end(),
                  [](const Problem& problem) { return is_located(problem.walls); })) {
    std::transform(problems.begin(), problems.end(), std::back_inserter(resolved), as_resolved);
    problems = resolved;
  }
  return run_each_alone(problems, steps, look_every, is_good, options);
}

}  // namespace bounce
