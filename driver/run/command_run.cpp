// bounce run: from a scene to a directory of results.
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "driver/output/run_directory.hpp"
#include "driver/run/advice_text.hpp"
#include "driver/run/run_job.hpp"
#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/scene/step_check.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/limits.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

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
  double checkpoint_every = usual_checkpoints;

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
void check_before(const SceneFile& file, const Problem& problem, const Options& options) {
  const auto check = check_step(problem);
  if (!options.force) refuse_unstable_step(file, problem, check);
  if (options.quiet) return;
  std::vector<std::string> warnings{warning_of_lost_motion(problem, file.scene())};
  if (check) {
    print_out("{}\n", describe(*check, problem));
    flush_output();
    warnings.push_back(warning_of(*check, file.scene()));
  }
  for (const std::string& warning : warnings) {
    if (!warning.empty()) print_err("bounce: warning: {}\n", warning);
  }
}

void check_final_state(const Options& options) {
  if (options.final_state.empty()) return;
  if (plain_path(options.final_state) == plain_path(options.directory())) {
    throw InputError(fmt::format(
        "--final-state {}: is where the results go; allowed is another name", options.final_state));
  }
  check_output_path(options.final_state, options.force);
}

int run(const Options& options, const std::string& command_line) {
  SceneFile file = load_scene(options);
  check_final_state(options);
  if (!(options.checkpoint_every >= 0.0)) {
    throw InputError(fmt::format("--checkpoint-every {}: allowed is 0 (never) or more, in seconds",
                                 options.checkpoint_every));
  }
  check_memory(file, options.request.kernel, available_memory());
  catch_interrupts();
  RunDirectory directory(options.directory(), options.force);
  FiledState start;
  std::optional<State> initial;
  if (!options.initial.empty()) {
    start = read_state(options.initial);
    initial = std::move(start.state);
  }
  RunJob job;
  if (options.error) {
    const auto advice = take_advice(options, initial, file);
    if (!advice) {
      print_err("bounce: interrupted; nothing was written\n");
      return interrupt_exit_code();
    }
    job.settings.advice = *advice;
    if (!options.quiet) print_out("{}\n", *advice);
  }
  check_memory(file, options.request.kernel, available_memory());
  job.settings.command = command_line;
  job.settings.scene_name = options.scene;
  job.settings.initial = options.initial;
  job.settings.request = options.request;
  if (!options.final_state.empty()) job.settings.final_state = fs::absolute(options.final_state);
  job.settings.listing_frames = options.listing_frames;
  job.settings.ledger = options.ledger;
  job.settings.quiet = options.quiet;
  job.scene = file.scene();
  job.problem = load_problem(file, initial);
  initial.reset();
  job.held = std::move(start.held);
  job.checkpoint_every = options.checkpoint_every;
  check_before(file, job.problem, options);
  return carry_out(job, directory);
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
  command.add_option("--checkpoint-every", options.checkpoint_every,
                     "Write the run down every N seconds, for bounce resume; 0: never [60]");
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
      "checkpoint: what bounce resume goes on from.\n"
      "Exit code: 0 complete, 2 bad input, 3 unstable, 4 a file could not be written, 130, 143 or\n"
      "129 stopped with Ctrl-C, SIGTERM or SIGHUP, 1 anything else.\n\n"
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
