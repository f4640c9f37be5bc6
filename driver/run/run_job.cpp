#include "driver/run/run_job.hpp"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/run/run_loop.hpp"
#include "driver/run/run_record.hpp"
#include "driver/run/run_summary.hpp"
#include "driver/run/run_writer.hpp"
#include "driver/run/trouble_text.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/origin.hpp"
#include "driver/world/progress.hpp"
#include "verify/oracle/oracle_stepper.hpp"
#include "verify/watch/booking_stepper.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

constexpr int exit_unstable = 3;
constexpr int exit_not_written = 4;

// The plan's kernel, with its books (null: none) if the ledger is asked for.
struct RunStepper {
  std::unique_ptr<Stepper> stepper;
  const WallBooks* books = nullptr;
};
RunStepper make_run_stepper(const RunJob& job, const Plan& plan) {
  if (!job.settings.ledger) return {plan.make_stepper()};
  if (plan.cuts_steps) {
    throw InputError(
        "--ledger: allowed is wall.contact listing or resolved; located contact cuts steps, and "
        "these books are of whole ones (the monitor's ledger is there in any case)");
  }
  auto booking = make_booking_stepper(job.scene, job.problem, plan);
  const WallBooks* books = &booking->books();
  return {std::move(booking), books};
}

bool same_bits(const State& a, const State& b) { return state_hash(a) == state_hash(b); }

// A start that a run wrote goes on as that run would have, if it is this run's: its held stage,
// done by this kernel with this scene, must give the state beside it.
void take_held_stage(const RunJob& job, const Plan& plan, Stepper& stepper) {
  const std::string& file = job.settings.initial;
  if (file.empty() || job.from) return;
  const auto note = [&](const char* why) {
    if (job.settings.quiet) return;
    print_err("bounce: note: {}: {}; \"bounce resume DIR --t-end T\" does\n", file, why);
  };
  if (plan.cuts_steps) {
    note(
        "from a file the course goes on within roundings, not to the bit, as located contact "
        "knows more than a state can hold");
    return;
  }
  if (!job.held) return;
  stepper.restore({*job.held, true, 0});
  if (same_bits(stepper.state(), job.problem.initial)) return;
  stepper.restore({job.problem.initial, false, 0});
  note(
      "was written by another kernel, method, step or scene, so the course does not go on to the "
      "bit");
}

// When a run is written down, and how.
class Checkpoints {
 public:
  Checkpoints(const RunJob& job, const Plan& plan, RunDirectory& directory, RunWriter& writer)
      : every_(job.checkpoint_every), directory_(directory), writer_(writer) {
    const Origin origin = find_origin();
    head_ = {.settings = job.settings,
             .version = origin.version,
             .commit = origin.commit,
             .scene = hash_of(job.scene),
             .start = state_hash(job.problem.initial)};
    head_.settings.request.kernel = plan.inside.empty() ? plan.kernel : plan.inside;
  }

  [[nodiscard]] bool due() const { return seconds_since(last_) >= every_; }
  void write(std::int64_t step, double time, const std::function<void(WordWriter&)>& loop) {
    head_.step = step;
    head_.time = time;
    // A run of less than a second is run once more as fast as a disk answers.
    const bool to_disk = seconds_since(began_) > 1.0;
    const auto body = [&](WordWriter& words) {
      writer_.write_down(words);
      loop(words);
    };
    if (to_disk) writer_.sync();
    write_checkpoint(directory_.path(), head_, body, to_disk);
    if (step > 0) directory_.keep();
    last_ = Clock::now();
  }

 private:
  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  double every_;
  RunDirectory& directory_;
  RunWriter& writer_;
  CheckpointHead head_;
  Clock::time_point began_ = Clock::now(), last_ = began_;
};

RunHooks make_hooks(const RunJob& job, const Schedule& schedule, Stepper& stepper,
                    RunWriter& writer, Progress& progress, Checkpoints& checkpoints) {
  RunHooks hooks;
  hooks.sample = [&](std::int64_t step, const Sample& sample, const State& state) {
    writer.sample(step, sample, state);
  };
  hooks.frame = [&](std::int64_t step, const State& state) { writer.frame(step, state); };
  hooks.listing_frame = [&](std::int64_t step, const State& state) {
    writer.listing_frame(step, step == schedule.end(), state);
  };
  hooks.progress = [&](std::int64_t step) { progress.update(step); };
  hooks.stop = interrupted;
  hooks.next_look = [&](std::int64_t step) { return writer.next_look(step); };
  hooks.look = [&] { writer.look(stepper); };
  if (job.checkpoint_every <= 0.0) return hooks;
  hooks.checkpoint_due = [&] { return checkpoints.due(); };
  hooks.checkpoint = [&](const std::function<void(WordWriter&)>& loop) {
    const std::int64_t step = stepper.step();
    checkpoints.write(step, static_cast<double>(step) * job.scene.time.step, loop);
  };
  return hooks;
}

// Runs and fills the directory with all that is written on the way.
void simulate(RunJob& job, RunDirectory& directory, Stepper& stepper, const WallBooks* books,
              RunRecord& record) {
  std::optional<WordReader> from;
  if (job.from) from.emplace(job.from->words);
  const Schedule schedule(job.scene, job.settings.listing_frames);
  RunWriter writer(job.scene, job.problem, directory.path(), books,
                   BounceGauge(job.problem, job.scene.time.step, remake(record.plan)),
                   from ? &*from : nullptr);
  Progress progress(::isatty(STDERR_FILENO) != 0 && !job.settings.quiet, schedule.end(),
                    job.scene.time.step);
  Checkpoints checkpoints(job, record.plan, directory, writer);
  job.problem.initial = State();  // the stepper holds the particles now
  const RunHooks hooks = make_hooks(job, schedule, stepper, writer, progress, checkpoints);
  record.result = run_loop(stepper, job.problem, schedule, hooks, from ? &*from : nullptr);
  record.findings = writer.finish(stepper, record.result.status == RunStatus::unstable);
  record.margin = writer.margin();
}

void print_summary(const RunRecord& record, const fs::path& directory) {
  const Plan& plan = record.plan;
  const RunResult& result = record.result;
  print_out("{}\n", printable(record.scene.title.empty() ? record.scene_name : record.scene.title));
  print_out("plan: kernel {}, vector {}, {} lane(s), {} thread(s); law {}; walls {}\n",
            kernel_name(plan), name_of(plan.vector), plan.lanes, plan.threads, plan.law,
            plan.walls);
  if (!plan.left_out.empty()) print_out("left out: {}\n", fmt::join(plan.left_out, ", "));
  print_out("{}: {} of {} steps, t = {:.9g} s\n", name_of(result.status), result.step,
            record.steps_asked, static_cast<double>(result.step) * record.scene.time.step);
  // A step that is rounded to single precision is up to 6e-8 of it longer or shorter.
  const double nominal = record.findings.time_step, stored = record.findings.integrated_step;
  if (std::abs(stored - nominal) > 4.0 * std::numeric_limits<double>::epsilon() * nominal) {
    print_out("        the steps, as they are stored, add up to {:.12g} s\n",
              static_cast<double>(result.step) * stored);
  }
  if (const auto& margin = record.margin) {
    const double time = static_cast<double>(margin->step) * record.scene.time.step;
    print_out("greatest part of the stable step used: {}\n", describe(*margin, time));
  }
  print_out("speed: {:.4g} steps/s, {:.3f} s\n", steps_per_second(result), result.seconds);
  print_out("{}", summary_text(record.findings));
  print_out("state hash: {:016x}\n", state_hash(result.last));
  print_out("files: {}\n", directory.string());
}

// Says on stderr why a run is not complete; the exit code.
int report_end(const RunRecord& record, const RunJob& job, const fs::path& directory) {
  switch (record.result.status) {
    case RunStatus::complete:
      return 0;
    case RunStatus::interrupted:
      print_err("bounce: interrupted at step {}; kept what was written, last state in {}\n",
                record.result.step, (directory / "final.csv").string());
      if (job.checkpoint_every > 0.0) {
        print_err("bounce: go on from there with: bounce resume {}\n", directory.string());
      }
      return interrupt_exit_code();
    case RunStatus::unstable:
      print_err("bounce: {}{}", trouble_text(record), how_to_go_on(record, directory.string()));
      return exit_unstable;
  }
  return 1;
}

RunRecord make_record(const RunJob& job) {
  RunRecord record;
  record.command = job.settings.command;
  record.scene_name = job.settings.scene_name;
  record.initial = job.settings.initial;
  record.advice = job.settings.advice;
  record.resumed = job.settings.resumed;
  record.scene = job.scene;
  record.steps_asked = job.scene.steps_until(job.scene.time.end);
  record.step_check = check_step(job.problem);
  record.particles = job.problem.initial.size();
  record.bonds = job.problem.bonds.bonds();
  return record;
}

// Writes what the end of a run leaves, and gives the directory its name.
void write_end(const RunJob& job, RunDirectory& directory, RunRecord& record) {
  if (const RunResult& result = record.result; result.trouble) {
    record.trouble_report =
        report_trouble(job.problem, *result.trouble, result.start_refused ? nullptr : &result.last,
                       result.refused, record.margin);
  }
  const auto write_last = [&record](OutputFile& out) {
    const bool whole_steps = !record.plan.cuts_steps;
    write_state_csv(out, record.result.last, whole_steps ? record.result.held : std::nullopt);
  };
  write_file_whole(directory.path() / "final.csv", write_last);
  write_file_whole(directory.path() / "run.json", run_json(record));
  if (record.result.status == RunStatus::unstable) remove_checkpoints(directory.path());
  if (record.result.status == RunStatus::complete) remove_checkpoint_before(directory.path());
  directory.publish();
  if (!job.settings.final_state.empty()) write_file_whole(job.settings.final_state, write_last);
}

// What is left of a run that could not write on.
int report_not_written(const OutputError& error, const RunDirectory& directory) {
  print_err("bounce: {}\n", error.what());
  try {
    if (!directory.is_kept()) throw OutputError("a run of no step is removed");
    const Checkpoint last = load_checkpoint(directory.path(), false, true);
    print_err(
        "bounce: the run stands at step {} (t = {:.9g} s) in {}; go on from there with: bounce "
        "resume {}\n",
        last.head.step, last.head.time, directory.path().string(), directory.name());
  } catch (const std::exception&) {
    print_err("bounce: nothing of the run is left to go on with\n");
  }
  return exit_not_written;
}

}  // namespace

int carry_out(RunJob& job, RunDirectory& directory) {
  RunRecord record = make_record(job);
  const std::vector<KernelEntry> entries = kernels_with_oracle(job.scene);
  record.plan = make_plan(job.problem, job.settings.request, entries);
  auto [stepper, books] = make_run_stepper(job, record.plan);
  take_held_stage(job, record.plan, *stepper);
  try {
    const fs::path& folder = directory.path();
    if (!job.from) {
      write_file_whole(folder / "scene.toml", to_toml(job.scene));
      if (!job.settings.initial.empty()) {
        write_file_whole(folder / "initial.csv",
                         [&job](OutputFile& out) { write_state_csv(out, job.problem.initial); });
      }
    }
    simulate(job, directory, *stepper, books, record);
    stepper.reset();
    write_end(job, directory, record);
  } catch (const OutputError& error) {
    return report_not_written(error, directory);
  }
  if (!job.settings.quiet) print_summary(record, directory.name());
  return report_end(record, job, directory.name());
}

}  // namespace bounce
