#include "verify/stability/trials.hpp"

#include <algorithm>

#include "kernels/plan/plan.hpp"
#include "kernels/stepping/threads.hpp"

namespace bounce {
namespace {

Problem without_located_contact(Problem problem) {
  for (Wall& wall : problem.walls) {
    if (wall.contact == Contact::located) wall.contact = Contact::resolved;
  }
  return problem;
}

}  // namespace

std::vector<bool> run_trials(std::span<const Problem> problems, std::span<const std::int64_t> steps,
                             std::int64_t look_every, const IsGood& is_good,
                             const TrialOptions& options) {
  check_threads(options.threads);
  choose_vector(options.vector);
  const PlanRequest request{"auto", options.vector, 1};
  std::vector<char> good(problems.size());  // not bool: written side by side
  parallel_for(problems.size(), options.threads, [&](std::size_t i) {
    const Problem problem = without_located_contact(problems[i]);
    const auto stepper = make_stepper(problem, request);
    for (std::int64_t done = 0; done < steps[i];) {
      const std::int64_t next = std::min(look_every, steps[i] - done);
      stepper->advance(next);
      done += next;
      const State state = stepper->state();
      if (!is_finite(state) || (options.stop && options.stop()) || !is_good(i, state)) return;
    }
    good[i] = 1;
  });
  return {good.begin(), good.end()};
}

}  // namespace bounce
