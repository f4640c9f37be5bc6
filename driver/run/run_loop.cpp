#include "driver/run/run_loop.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace bounce {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A state good enough to go on from, and the watch's opinion of another.
class RunLoop {
 public:
  RunLoop(Stepper& stepper, const Problem& problem, const Schedule& schedule, const RunHooks& hooks)
      : stepper_(stepper),
        problem_(problem),
        schedule_(schedule),
        hooks_(hooks),
        good_(stepper.save()),
        watch_(problem, stepper.state()) {}

  void go_on(WordReader& words);
  RunResult run();

 private:
  void write_down();
  bool advance_to(std::int64_t target);
  bool look(RunStatus status);
  void find_trouble();
  bool refuses(const State& state);

  Stepper& stepper_;
  const Problem& problem_;
  const Schedule& schedule_;
  const RunHooks& hooks_;
  Snapshot good_;
  Watch watch_;
  RunResult result_;
  bool looked_ = false;          // at the start
  double seconds_before_ = 0.0;  // of the run before it was gone on with
  Clock::time_point began_ = Clock::now();
  std::int64_t chunk_ = 1;  // steps between two looks at the stop flag
};

// Everything that the course to come depends on, and the files.
void RunLoop::write_down() {
  if (!hooks_.checkpoint) return;
  hooks_.checkpoint([this](WordWriter& words) {
    words(stepper_.save(), good_, watch_, result_.start, seconds_before_ + seconds_since(began_));
  });
}

void RunLoop::go_on(WordReader& words) {
  Snapshot now;
  words(now, good_, watch_, result_.start, seconds_before_);
  stepper_.restore(now);
  looked_ = true;
}

// Advances in chunks of about 50 ms, so that Ctrl-C is answered at once. False if asked to stop.
bool RunLoop::advance_to(std::int64_t target) {
  constexpr double chunk_seconds = 0.05;
  while (stepper_.step() < target) {
    if (hooks_.stop()) return false;
    const std::int64_t now = stepper_.step(),
                       look = hooks_.next_look ? hooks_.next_look(now) : target;
    const std::int64_t steps = std::min({chunk_, target - now, look - now});
    const auto start = Clock::now();
    stepper_.advance(steps);
    const double seconds = seconds_since(start);
    if (steps == chunk_ && seconds < 0.5 * chunk_seconds) chunk_ *= 2;
    if (seconds > chunk_seconds) chunk_ = std::max<std::int64_t>(1, steps / 2);
    if (hooks_.look && stepper_.step() == look) hooks_.look();
    hooks_.progress(stepper_.step());
    if (hooks_.checkpoint_due && hooks_.checkpoint_due()) write_down();
  }
  return true;
}

// Checks the state and hands it to whoever is due. False if the watch refuses it.
bool RunLoop::look(RunStatus status) {
  const State state = stepper_.state();
  const Sample sample = measure(problem_, state);
  const std::int64_t step = stepper_.step();
  result_.trouble = watch_.check(state, sample);
  if (result_.trouble) return false;
  watch_.accept(sample);
  good_ = stepper_.save();
  if (step == 0) result_.start = sample;
  if (schedule_.sample_due(step) || status == RunStatus::interrupted) {
    hooks_.sample(step, sample, state);
  }
  if (schedule_.frame_due(step)) hooks_.frame(step, state);
  if (schedule_.listing_frame_due(step)) hooks_.listing_frame(step, state);
  return true;
}

// Asks the watch; a refused state takes the place of the refused one known.
bool RunLoop::refuses(const State& state) {
  auto trouble = watch_.check(state, measure(problem_, state));
  if (!trouble) return false;
  result_.trouble = std::move(trouble);
  result_.trouble_step = stepper_.step();
  result_.refused = state;
  return true;
}

// The stepper stands at a refused step, good_ before it. Leaves the stepper at the last good step.
void RunLoop::find_trouble() {
  result_.status = RunStatus::unstable;
  result_.trouble_step = stepper_.step();
  result_.refused = stepper_.state();
  result_.start_refused = stepper_.step() == good_.step;
  const std::int64_t most = steps_to_look_at(good_.state.size());
  while (result_.trouble_step - good_.step > most) {
    stepper_.restore(good_);
    stepper_.advance((result_.trouble_step - good_.step) / 2);
    if (!refuses(stepper_.state())) good_ = stepper_.save();
  }
  result_.looked_from = good_.step;
  stepper_.restore(good_);
  while (stepper_.step() + 1 < result_.trouble_step) {
    stepper_.advance(1);
    if (refuses(stepper_.state())) break;
  }
  stepper_.restore(good_);
  if (!result_.start_refused) stepper_.advance(result_.trouble_step - 1 - good_.step);
}

RunResult RunLoop::run() {
  bool good = looked_;
  if (!looked_) {
    if (hooks_.look) hooks_.look();
    good = look(RunStatus::complete);
    if (good) write_down();
  }
  while (good && result_.status == RunStatus::complete && good_.step < schedule_.end()) {
    const std::int64_t target = schedule_.next(good_.step);
    if (!advance_to(target)) result_.status = RunStatus::interrupted;
    const bool ends = result_.status == RunStatus::interrupted || target == schedule_.end();
    if (ends) write_down();
    if (stepper_.step() > good_.step) good = look(result_.status);
  }
  result_.seconds = seconds_before_ + seconds_since(began_);
  result_.steps_timed = stepper_.step();
  if (!good) find_trouble();
  result_.step = stepper_.step();
  const Snapshot last = stepper_.save();
  result_.last = stepper_.state();
  if (last.stage_held) result_.held = last.state;
  return std::move(result_);
}

}  // namespace

std::int64_t steps_to_look_at(std::size_t particles) {
  constexpr std::int64_t particle_steps = std::int64_t{360} * 10000;
  constexpr std::int64_t least = 100;
  return std::max(least,
                  particle_steps / static_cast<std::int64_t>(std::max<std::size_t>(particles, 1)));
}

RunResult run_loop(Stepper& stepper, const Problem& problem, const Schedule& schedule,
                   const RunHooks& hooks, WordReader* from) {
  RunLoop loop(stepper, problem, schedule, hooks);
  if (from != nullptr) loop.go_on(*from);
  return loop.run();
}

}  // namespace bounce
