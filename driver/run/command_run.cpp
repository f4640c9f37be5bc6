// bounce run: from a scene to a directory of results.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/run/advice_text.hpp"
#include "driver/run/extended_xyz.hpp"
#include "driver/run/ledger_csv.hpp"
#include "driver/run/monitor_csv.hpp"
#include "driver/run/run_gauges.hpp"
#include "driver/run/run_loop.hpp"
#include "driver/run/run_record.hpp"
#include "driver/run/run_summary.hpp"
#include "driver/run/trouble_text.hpp"
#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/scene/state_file.hpp"
#include "driver/scene/step_check.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/progress.hpp"
#include "driver/world/run_directory.hpp"
#include "verify/oracle/listing_frame.hpp"
#include "verify/oracle/oracle_stepper.hpp"
#include "verify/watch/booking_stepper.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

constexpr int exit_unstable = 3;

struct Options {
  std::string scene;
  std::string out;
  std::vector<std::string> settings;
  std::optional<std::int64_t> steps;
  std::optional<double> end;
  PlanRequest request;
  std::string initial;
  std::string final_state;
  std::optional<double> error;
  std::string observable = "height";
  bool listing_frames = false;
  bool ledger = false;
  bool force = false;
  bool quiet = false;

  [[nodiscard]] fs::path directory() const {
    return out.empty() ? fs::path("runs") / fs::path(scene).stem() : fs::path(out);
  }
};

// Puts the cheapest setting that reaches the asked error into the scene; says which. Nothing if
// interrupted.
std::optional<std::string> take_advice(const Options& options, const std::optional<State>& start,
                                       SceneFile& file) {
  AdviceRequest request;
  request.scene = file.scene();
  request.initial = start;
  request.error = *options.error;
  request.observable = options.observable;
  request.books = options.ledger;
  load_problem(file, start);  // throws what is wrong with it
  const auto advice = ask_advice(request);
  if (!advice) return std::nullopt;
  for (const std::string& setting : settings_of(*advice, request.scene)) file.set(setting);
  return describe(*advice, request);
}

// The scene with all that the command line changes in it.
SceneFile load_scene(const Options& options) {
  SceneFile file = SceneFile::find(options.scene);
  for (const std::string& setting : options.settings) file.set(setting);
  if (options.end) file.end_at(*options.end, "--t-end");
  if (options.steps) {
    if (*options.steps < 1) {
      throw InputError(fmt::format("--steps {}: allowed is 1 or more", *options.steps));
    }
    file.end_after(*options.steps, "--steps");
  }
  if (!options.initial.empty()) file.note_origin("initial state", options.initial);
  const Scene scene = file.scene();
  if (scene.steps_until(scene.time.end) < 1) {
    throw file.explain(SceneError("time.end", fmt::format("{}", scene.time.end),
                                  fmt::format("at least one step, {} s", scene.time.step)));
  }
  return file;
}

// Says before the run how near it is to the edge of stability. Beyond it runs only with --force.
std::optional<StepCheck> check_before(const SceneFile& file, const Problem& problem,
                                      const Options& options) {
  const auto check = check_step(problem);
  if (!options.force) refuse_unstable_step(file, problem, check);
  if (options.quiet) return check;
  std::vector<std::string> warnings{warning_of_lost_motion(problem, file.scene())};
  if (check) {
    print_out("{}\n", describe(*check, problem));
    flush_output();
    warnings.push_back(warning_of(*check, file.scene()));
  }
  for (const std::string& warning : warnings) {
    if (!warning.empty()) print_err("bounce: warning: {}\n", warning);
  }
  return check;
}

void write_text(const fs::path& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.close();
}

// BAL4.OUT1 at the first million steps and so on, BAL4.OUT at the end. As in the listing, the end
// has no numbered file of its own beyond the nineteenth.
void write_listing_frames(const fs::path& folder, std::int64_t step, bool is_end,
                          const State& state) {
  constexpr std::int64_t million = 1'000'000;
  constexpr std::int64_t numbered_files = 19;
  const auto write = [&](const std::string& name) {
    std::ostringstream text;
    write_listing_frame(text, state);
    write_text(folder / name, text.str());
  };
  if (step % million == 0 && (step / million <= numbered_files || !is_end)) {
    write(fmt::format("BAL4.OUT{}", step / million));
  }
  if (is_end) write("BAL4.OUT");
}

// Runs and fills the directory with all that is written on the way. `books`: the stepper's, or
// null.
RunResult simulate(const Options& options, const Scene& scene, const Problem& problem,
                   Stepper& stepper, const WallBooks* books, const fs::path& folder,
                   BounceGauge figures, RunFindings& findings, MarginGauge& margin) {
  const Schedule schedule(scene, options.listing_frames);
  const auto time = [&scene](std::int64_t step) {
    return static_cast<double>(step) * scene.time.step;
  };
  MonitorCsv monitor(folder / "monitor.csv");
  const bool has_rings = scene.ball.kind == BallKind::rings;
  ExtendedXyz frames(folder / "frames.extxyz", has_rings
                                                   ? static_cast<std::size_t>(scene.ball.per_ring)
                                                   : problem.bonds.particles());
  Progress progress(::isatty(STDERR_FILENO) != 0 && !options.quiet, schedule.end(),
                    scene.time.step);
  RunGauges gauges(problem, std::move(figures), scene.time.step, books != nullptr);
  std::optional<LedgerCsv> ledger;
  if (books != nullptr) ledger.emplace(folder / "ledger.csv");
  RunHooks hooks;
  hooks.sample = [&](std::int64_t step, const Sample& sample, const State& state) {
    gauges.add(step, sample, state, books);
    monitor.write(time(step), sample, gauges.last(), margin.add(step, state));
    if (ledger && step > 0) ledger->write(time(step), gauges.last());
  };
  hooks.frame = [&](std::int64_t step, const State& state) {
    frames.write(step, time(step), state);
  };
  hooks.listing_frame = [&](std::int64_t step, const State& state) {
    write_listing_frames(folder, step, step == schedule.end(), state);
  };
  hooks.progress = [&](std::int64_t step) { progress.update(step); };
  hooks.stop = interrupted;
  hooks.next_look = [&](std::int64_t step) { return gauges.next_look(step); };
  hooks.look = [&] { gauges.look(stepper); };
  RunResult result = run_loop(stepper, problem, schedule, hooks);
  findings = gauges.findings(stepper, result.status == RunStatus::unstable);
  monitor.close();
  if (ledger) ledger->close();
  frames.close();
  return result;
}

void print_summary(const RunRecord& record, const Options& options) {
  const Plan& plan = record.plan;
  const RunResult& result = record.result;
  print_out("{}\n", printable(record.scene.title.empty() ? record.scene_name : record.scene.title));
  print_out("plan: kernel {}, vector {}, {} lane(s), {} thread(s); law {}; walls {}\n",
            kernel_name(plan), name_of(plan.vector), plan.lanes, plan.threads, plan.law,
            plan.walls);
  if (!plan.left_out.empty()) print_out("left out: {}\n", fmt::join(plan.left_out, ", "));
  print_out("{}: {} of {} steps, t = {:.9g} s\n", name_of(result.status), result.step,
            record.steps_asked, static_cast<double>(result.step) * record.scene.time.step);
  if (const auto& margin = record.margin) {
    const double time = static_cast<double>(margin->step) * record.scene.time.step;
    print_out("greatest part of the stable step used: {}\n", describe(*margin, time));
  }
  print_out("speed: {:.4g} steps/s, {:.3f} s\n", steps_per_second(result), result.seconds);
  print_out("{}", summary_text(record.findings));
  print_out("state hash: {:016x}\n", state_hash(result.last));
  print_out("files: {}\n", options.directory().string());
}

// Says on stderr why a run is not complete; the exit code.
int report_end(const RunRecord& record, const Options& options) {
  const fs::path last = options.directory() / "final.csv";
  switch (record.result.status) {
    case RunStatus::complete:
      return 0;
    case RunStatus::interrupted:
      print_err("bounce: interrupted at step {}; kept what was written, last state in {}\n",
                record.result.step, last.string());
      return interrupt_exit_code();
    case RunStatus::unstable:
      print_err("bounce: {}{}", trouble_text(record),
                how_to_go_on(record, options.directory().string()));
      return exit_unstable;
  }
  return 1;
}

void check_final_state(const Options& options) {
  if (options.final_state.empty()) return;
  if (plain_path(options.final_state) == plain_path(options.directory())) {
    throw InputError(fmt::format(
        "--final-state {}: is where the results go; allowed is another name", options.final_state));
  }
  check_output_path(options.final_state, options.force);
}

// The plan's kernel, with its books (null: none) if the ledger is asked for.
struct RunStepper {
  std::unique_ptr<Stepper> stepper;
  const WallBooks* books = nullptr;
};
RunStepper make_run_stepper(const Options& options, const RunRecord& record,
                            const Problem& problem) {
  if (!options.ledger) return {record.plan.make_stepper()};
  if (record.plan.cuts_steps) {
    throw InputError(
        "--ledger: allowed is wall.contact listing or resolved; located contact cuts steps, and "
        "these books are of whole ones (the monitor's ledger is there in any case)");
  }
  auto booking = make_booking_stepper(record.scene, problem, record.plan);
  const WallBooks* books = &booking->books();
  return {std::move(booking), books};
}

int run(const Options& options, const std::string& command_line) {
  SceneFile file = load_scene(options);
  check_final_state(options);
  check_memory(file, options.request.kernel, available_memory());
  catch_interrupts();
  RunDirectory directory(options.directory(), options.force);
  std::optional<State> start = load_start(options.initial);
  RunRecord record;
  if (options.error) {
    const auto advice = take_advice(options, start, file);
    if (!advice) {
      print_err("bounce: interrupted; nothing was written\n");
      return interrupt_exit_code();
    }
    record.advice = *advice;
    if (!options.quiet) print_out("{}\n", record.advice);
  }
  record.command = command_line;
  record.scene_name = options.scene;
  record.initial = options.initial;
  record.scene = file.scene();
  record.steps_asked = record.scene.steps_until(record.scene.time.end);
  check_memory(file, options.request.kernel, available_memory());
  Problem problem = load_problem(file, start);
  start.reset();
  record.step_check = check_before(file, problem, options);
  record.particles = problem.initial.size();
  record.bonds = problem.bonds.bonds();
  const std::vector<KernelEntry> entries = kernels_with_oracle(record.scene);
  record.plan = make_plan(problem, options.request, entries);
  auto [stepper, books] = make_run_stepper(options, record, problem);
  BounceGauge figures(problem, record.scene.time.step, remake(record.plan));
  problem.initial = State();  // the stepper holds the particles now

  write_text(directory.path() / "scene.toml", to_toml(record.scene));
  MarginGauge margin(problem);
  record.result = simulate(options, record.scene, problem, *stepper, books, directory.path(),
                           std::move(figures), record.findings, margin);
  record.margin = margin.result();
  if (const RunResult& result = record.result; result.trouble) {
    record.trouble_report =
        report_trouble(problem, *result.trouble, result.start_refused ? nullptr : &result.last,
                       result.refused, record.margin);
  }
  const auto write_last = [&record](OutputFile& out) { write_state_csv(out, record.result.last); };
  write_file_whole(directory.path() / "final.csv", write_last);
  write_text(directory.path() / "run.json", run_json(record));
  directory.publish();
  if (!options.final_state.empty()) write_file_whole(options.final_state, write_last);
  if (!options.quiet) print_summary(record, options);
  return report_end(record, options);
}

void add_options(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scene, "Built-in scene (see bounce list) or scene file")
      ->required();
  command.add_option("-o,--out", options.out, "Directory of the results [runs/SCENE]");
  add_set_option(command, options.settings);
  CLI::Option* steps = command.add_option("--steps", options.steps, "Stop after N steps");
  command.add_option("--t-end", options.end, "Stop at time T, s")->excludes(steps);
  CLI::Option* kernel = command.add_option("--kernel", options.request.kernel,
                                           "auto, or a kernel of bounce list [auto]");
  command.add_option("--vector", options.request.vector, "auto, avx2 or avx512 [auto]");
  command.add_option("--threads", options.request.threads, "1 to 256; 0: as the plan decides [0]");
  command.add_option(
      "--initial", options.initial,
      "Start from FILE: the listing's format (x, y, vx, vy as 4F12.4), or the CSV of "
      "--final-state");
  command.add_option("--final-state", options.final_state,
                     "Write the last state to FILE: CSV, 17 significant digits");
  auto* error =
      command.add_option("--error", options.error,
                         "Asked error: method, step and contact are chosen as bounce advise does");
  error->excludes(steps)->excludes(kernel);
  command.add_option("--observable", options.observable, "Of which it is the error [height]")
      ->needs(error);
  command.add_flag("--listing-frames", options.listing_frames,
                   "Write BAL4.OUT1, ... and BAL4.OUT as the listing does");
  command.add_flag("--ledger", options.ledger,
                   "Book every reflection at a wall: the same bits, several times slower");
  command.add_flag("--force", options.force,
                   "Replace results that exist, and run a time step beyond the stable one");
  command.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

}  // namespace

void add_run_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("run", "Run a scene and write its results");
  add_options(*command, *options);
  command->footer(
      "The results: scene.toml (all values), run.json (what ran, where, how fast), monitor.csv\n"
      "(energies and momenta), frames.extxyz (opens in OVITO and ASE), final.csv (last state); "
      "with\n"
      "--ledger also ledger.csv (what walls and integrator did from sample to sample).\n"
      "Exit code: 0 complete, 2 bad input, 3 unstable, 130, 143 or 129 stopped with Ctrl-C, "
      "SIGTERM\n"
      "or SIGHUP, 1 anything else.\n\n"
      "Examples:\n"
      "  bounce run example-2\n"
      "  bounce run example-2 --set law.elasticity=1000 --out runs/soft\n"
      "  bounce run example-5 --set wall.alpha=1 --set wall.beta=-1 --t-end 10\n"
      "  bounce run example-1 --kernel oracle --steps 1000000 --listing-frames --force\n"
      "  bounce run my-ball.toml --initial BALL.DAT --final-state last.csv\n");
  command->callback(
      [options, &context] { context.exit_code = run(*options, context.command_line); });
}

}  // namespace bounce
