// bounce reference: a scene solved twice, by methods that share neither steps nor arithmetic, and
// what they differ by.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/accuracy/reference_journal.hpp"
#include "driver/accuracy/reference_record.hpp"
#include "driver/output/journal.hpp"
#include "driver/output/run_directory.hpp"
#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/scene/state_file.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/limits.hpp"
#include "driver/world/progress.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/accuracy/reference_pair.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

constexpr const char* marker = "observables.json";

struct Interrupted {};

struct Options {
  std::string scene;
  std::vector<std::string> settings;
  std::string initial;
  std::optional<double> end;
  double every = 0.01;
  double tolerance = AdaptiveSettings{}.tolerance;
  std::optional<double> step;
  double disturbance = 1e-10;
  std::string out;
  bool force = false;

  [[nodiscard]] fs::path directory() const {
    return out.empty() ? fs::path("runs") / (fs::path(scene).stem().string() + "-reference")
                       : fs::path(out);
  }
};

void demand(std::string_view option, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw InputError(fmt::format("{} {}: allowed is {} to {}", option, value, low, high));
  }
}

// The output times in nominal steps: multiples of --every, and the end.
std::vector<std::int64_t> output_steps(const Scene& scene, double every) {
  const std::int64_t end = scene.steps_until(scene.time.end);
  demand("--every", every, scene.time.step, scene.time.end);
  const std::int64_t stride = std::max<std::int64_t>(1, scene.steps_until(every));
  std::vector<std::int64_t> steps;
  for (std::int64_t step = 0; step < end; step += stride) steps.push_back(step);
  steps.push_back(end);
  return steps;
}

double shortest_bond(const Problem& problem) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const BondClass& bond : problem.classes) shortest = std::min(shortest, bond.rest);
  return shortest;
}

DisturbedPair solve(const Problem& problem, const std::vector<double>& times,
                    const ReferenceSettings& settings, double disturbance, Journal& journal) {
  std::atomic<std::size_t> done{0};
  const auto main_thread = std::this_thread::get_id();
  const std::size_t all = 3 * times.size();
  CaseProgress progress(::isatty(STDERR_FILENO) != 0, all, static_cast<double>(all));
  const auto tick = [&] {
    const std::size_t now = ++done;
    if (interrupted()) throw Interrupted{};
    if (std::this_thread::get_id() == main_thread) progress.update(now, static_cast<double>(now));
  };
  try {
    return solve_disturbed(problem, times, settings, disturbance, tick, kept_in(journal));
  } catch (const ReferenceError& error) {
    throw InputError(fmt::format("this scene has no reference: {}", error.what()));
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
}

void write_files(const fs::path& folder, const ReferenceRecord& record) {
  const ReferencePair& pair = record.pair();
  const auto write_state = [&](const char* name, const State& state) {
    write_file_whole(folder / name, [&](OutputFile& file) { write_state_csv(file, state); });
  };
  write_state("final.csv", pair.fixed.states.back());
  write_state("before-impact.csv", pair.fixed.states[pair.last_before_contact()]);
  write_file_whole(folder / "reference.csv",
                   [&](OutputFile& file) { write_reference_csv(file, record); });
  write_file_whole(folder / "contacts.csv",
                   [&](OutputFile& file) { write_contacts_csv(file, record); });
}

// What the solutions depend on.
std::string task_of(const Scene& scene, const Problem& problem, const std::vector<double>& times,
                    const ReferenceSettings& settings, double disturbance) {
  const nlohmann::ordered_json json{{"scene", to_toml(scene)},
                                    {"start", fmt::format("{:016x}", state_hash(problem.initial))},
                                    {"times", times.size()},
                                    {"last", times.back()},
                                    {"tolerance", settings.adaptive.tolerance},
                                    {"step", settings.fixed.step},
                                    {"disturbance", disturbance}};
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

int reference(const Options& options, const CommandContext& context) {
  SceneFile file = SceneFile::find(options.scene);
  for (const std::string& setting : options.settings) file.set(setting);
  if (options.end) file.end_at(*options.end, "--t-end");
  if (!options.initial.empty()) file.note_origin("initial state", options.initial);
  choose_vector("auto");  // throws on a processor that BondForces is not compiled for
  check_memory(file, "auto", available_memory());
  catch_interrupts();
  RunDirectory directory(options.directory(), options.force, marker);
  const Problem problem = load_problem(file, load_start(options.initial));
  const Scene scene = file.scene();

  demand("--tolerance", options.tolerance, 1e-15, 1e-2);
  demand("--disturbed", options.disturbance, 1e-15, 1.0);
  if (options.step) demand("--step", *options.step, 1e-12, scene.time.end);
  const std::vector<std::int64_t> steps = output_steps(scene, options.every);
  check_path_memory(problem.initial.size(), static_cast<double>(steps.size()));
  std::vector<double> times;
  times.reserve(steps.size());
  for (const std::int64_t step : steps) {
    times.push_back(static_cast<double>(step) * scene.time.step);
  }
  ReferenceSettings settings;
  settings.adaptive.tolerance = options.tolerance;
  try {
    settings.fixed.step = options.step.value_or(default_reference_step(problem));
  } catch (const ReferenceError& error) {
    throw InputError(error.what());
  }
  const double disturbance = options.disturbance * shortest_bond(problem);
  Journal journal(options.directory(), context.asked,
                  task_of(scene, problem, times, settings, disturbance), options.force);
  constexpr std::size_t solutions = 3;
  say_going_on(journal.size(), solutions);
  ReferenceRecord record;
  try {
    record = make_reference_record(problem, solve(problem, times, settings, disturbance, journal),
                                   disturbance);
  } catch (const InputError&) {
    journal.finish();
    throw;
  } catch (const Interrupted&) {
    say_stopped(journal.size(), solutions, journal, options.directory());
    return interrupt_exit_code();
  }
  write_file_whole(directory.path() / "scene.toml", to_toml(scene));
  write_files(directory.path(), record);
  write_file_whole(directory.path() / marker, reference_json(record, scene, settings, options.every,
                                                             options.scene, context.command_line));
  directory.publish();
  journal.finish();
  print_out("{}\nfiles: {}\n", reference_table(record, settings), options.directory().string());
  return 0;
}

}  // namespace

void add_reference_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "reference", "Solve a scene in two independent ways, with an error bar");
  command->add_option("SCENE", options->scene, "Built-in scene (see bounce list) or scene file")
      ->required();
  add_set_option(*command, options->settings);
  command->add_option("--initial", options->initial,
                      "Start from the state in FILE: the listing's format, or the CSV of "
                      "bounce run's --final-state");
  command->add_option("--t-end", options->end, "End of the time, s [the scene's]");
  command->add_option("--every", options->every, "Time between two samples, s")
      ->capture_default_str();
  command
      ->add_option("--tolerance", options->tolerance,
                   "Error of a step of the adaptive solution, in the ball's size")
      ->capture_default_str();
  command->add_option("--step", options->step,
                      "Step of the other solution, s [1/8 of leapfrog's stable step]");
  command
      ->add_option("--disturbed", options->disturbance,
                   "Disturbance of the third run's start, in shortest bonds")
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "Directory of the results [runs/SCENE-reference]");
  command->add_flag("--force", options->force, "Replace results that exist");
  command->footer(
      "The model in continuous time, with the walls' rule in the limit of small steps, is solved\n"
      "by GSL's adaptive rk8pd in double precision and by Blanes and Moan's symplectic method of\n"
      "order 6 with fixed steps in extended precision; contacts are located by root finding. What\n"
      "the two differ by, twice, is the error bar. The time step, method and contact rule of "
      "the\n"
      "scene do not enter. A third run, from a start disturbed a little, shows how errors grow.\n"
      "Results: reference.csv (per sample: centre, its velocity, energies, lowest point; the\n"
      "difference beside each), final.csv, before-impact.csv (the last sample before the first\n"
      "contact), contacts.csv, observables.json (each with its error; settings, origin),\n"
      "scene.toml.\n"
      "Exit code: 0 done, 2 bad input or a scene that has no reference, 130, 143 or 129\n"
      "stopped with Ctrl-C, SIGTERM or SIGHUP.\n"
      "Examples:\n"
      "  bounce reference example-2                 (some minutes on two cores)\n"
      "  bounce reference example-2 --t-end 9 --tolerance 1e-12 --step 1e-4 --out quick\n");
  command->callback([options, &context] { context.exit_code = reference(*options, context); });
}

}  // namespace bounce
