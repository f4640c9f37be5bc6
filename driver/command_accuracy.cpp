// bounce accuracy: error against run time of one scene, by method, contact rule and time step.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "driver/accuracy_table.hpp"
#include "driver/commands.hpp"
#include "driver/course_timing.hpp"
#include "driver/files.hpp"
#include "driver/input_error.hpp"
#include "driver/interrupt.hpp"
#include "driver/load_problem.hpp"
#include "driver/origin.hpp"
#include "driver/progress.hpp"
#include "driver/run_directory.hpp"
#include "driver/scene_file.hpp"
#include "driver/state_file.hpp"
#include "kernels/stepping/method.hpp"
#include "kernels/stepping/plan.hpp"
#include "verify/accuracy.hpp"
#include "verify/baseline.hpp"
#include "verify/reference_pair.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int exit_interrupted = 130;
constexpr double papers_step = 1e-6;  // s
constexpr double largest_part = 0.9;  // of the stable step at the start: an impact brings it nearer

struct Options {
  std::string scene;
  std::vector<std::string> settings;
  std::string initial;
  std::vector<std::string> methods;
  double every = 0.01;
  double decades = 3.0;
  int per_decade = 3;
  bool quick = false;
  int threads = 0;
  std::string out;
  bool force = false;

  [[nodiscard]] fs::path directory() const {
    return out.empty() ? fs::path("runs") / (fs::path(scene).stem().string() + "-accuracy")
                       : fs::path(out);
  }
};

// What is compared with what.
struct Study {
  SceneFile file;
  Scene scene;
  std::optional<State> initial;
  Sampling sampling;
  Setting papers;  // the paper's program, one of them if there is a wall
  std::vector<Setting> settings;
};

void check(const Options& options, const Scene& scene) {
  for (const std::string& name : options.methods) {
    if (find_method(name) != nullptr || is_baseline(name)) continue;
    std::vector<std::string> all;
    for (const Method& method : methods()) all.emplace_back(method.name);
    for (const Baseline& baseline : baselines()) {
      if (all.back() != baseline.name) all.emplace_back(baseline.name);
    }
    throw InputError(
        fmt::format("--methods {}: unknown; allowed is {}", name, fmt::join(all, ", ")));
  }
  if (!(options.every > 0.0 && options.every <= scene.time.end / 10.0)) {
    throw InputError(fmt::format("--every {}: allowed is above 0, at most a tenth of time.end = {}",
                                 options.every, scene.time.end));
  }
  if (!(options.decades > 0.0 && options.decades <= 6.0)) {
    throw InputError(fmt::format("--decades {}: allowed is above 0, at most 6", options.decades));
  }
  if (options.per_decade < 1 || options.per_decade > 100) {
    throw InputError(fmt::format("--per-decade {}: allowed is 1 to 100", options.per_decade));
  }
  check_threads(options.threads);
}

Study make_study(const Options& options) {
  SceneFile file = SceneFile::find(options.scene);
  for (const std::string& setting : options.settings) file.set(setting);
  if (!options.initial.empty()) file.note_origin("initial state", options.initial);
  load_problem(file, options.initial);  // throws what is wrong with it
  Study study{std::move(file), {}, {}, {}, {}, {}};
  study.scene = study.file.scene();
  check(options, study.scene);
  if (!options.initial.empty()) study.initial = read_state(options.initial);
  study.sampling = sampling_of(study.scene, options.every);
  const double decades = options.quick ? std::min(options.decades, 1.5) : options.decades;
  const int per_decade = options.quick ? std::min(options.per_decade, 2) : options.per_decade;
  for (const Method& method : methods()) {
    const auto& wanted = options.methods;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), method.name) == wanted.end()) {
      continue;
    }
    for (const Contact contact : {Contact::listing, Contact::resolved}) {
      // The paper's rule beside its own scheme and the simplest other one.
      const bool simple = method.evaluations == 1;
      if (contact == Contact::listing && (!simple || study.scene.walls.empty())) continue;
      const auto more = settings_of(study.scene, study.initial, std::string(method.name), contact,
                                    study.sampling, largest_part, decades, per_decade);
      study.settings.insert(study.settings.end(), more.begin(), more.end());
    }
  }
  study.papers = {"listing", Contact::listing, std::llround(study.sampling.every / papers_step)};
  auto& all = study.settings;
  if (!study.scene.walls.empty() && std::find(all.begin(), all.end(), study.papers) == all.end()) {
    all.insert(all.begin(), study.papers);
  }
  return study;
}

// Ctrl-C, within the reference.
struct Stopped {};

// The course, and how far two solutions of it are apart.
struct Reference {
  CourseRecord record;
  CourseErrors bar;
};

CourseRecord seen(const Problem& problem, int rings, const std::vector<double>& times,
                  const std::vector<State>& states, std::optional<std::size_t> free_samples = {}) {
  CourseGauge gauge(problem, rings, free_samples);
  for (std::size_t i = 0; i < times.size() && gauge.add(times[i], states[i]); ++i) {
  }
  return gauge.result();
}

Reference make_reference(const Study& study) {
  const Problem problem =
      problem_of(study.scene, study.initial, {"listing", Contact::resolved, 1}, study.sampling);
  std::vector<double> times;
  for (std::int64_t s = 0; s <= study.sampling.samples; ++s) {
    times.push_back(study.sampling.every * static_cast<double>(s));
  }
  const ReferencePair pair = solve_both(problem, times, {}, [] {
    if (interrupted()) throw Stopped();
  });
  const int rings = rings_of(study.scene);
  Reference reference;
  reference.record = seen(problem, rings, times, pair.fixed.states);
  reference.bar =
      errors_of(seen(problem, rings, times, pair.adaptive.states, reference.record.free_samples),
                reference.record);
  return reference;
}

Json origin_json(const Options& options, const Study& study, const std::string& command) {
  const Origin origin = find_origin();
  return {
      {"scene", options.scene},      {"command", command},        {"every", study.sampling.every},
      {"end", study.sampling.end()}, {"version", origin.version}, {"commit", origin.commit},
      {"compiler", origin.compiler}, {"flags", origin.flags},     {"cpu", origin.cpu},
      {"cores", origin.cores},       {"date", origin.date}};
}

std::optional<std::vector<AccuracyRow>> run_all(const Study& study, const Reference& reference,
                                                int threads) {
  double work = 0.0, done = 0.0;
  const auto work_of = [&](const Setting& s) {
    return static_cast<double>(s.steps_a_sample * find_method(s.method)->evaluations);
  };
  for (const Setting& setting : study.settings) work += work_of(setting);
  CaseProgress progress(::isatty(STDERR_FILENO) != 0, study.settings.size(), work);
  std::size_t ended = 0;
  return measure_accuracy(study.scene, study.initial, study.settings, study.sampling,
                          reference.record, threads, [&](std::size_t i) {
                            done += work_of(study.settings[i]);
                            progress.update(++ended, done);
                            return !interrupted();
                          });
}

// The baselines, one course at a time: they are timed as they run.
void add_baselines(const Options& options, const Study& study, const Reference& reference,
                   std::vector<TimedRow>& timed) {
  const auto& wanted = options.methods;
  BaselineSweep sweep;
  if (options.quick) sweep = {2, 10.0, 0.1};
  for (const Baseline& baseline : baselines()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), baseline.name) == wanted.end()) {
      continue;
    }
    if (study.scene.walls.empty() && baseline.contact == BaselineContact::listing) continue;
    const auto tick = [] {
      if (interrupted()) throw Stopped();
    };
    for (BaselineRow& each : measure_baseline(baseline, study.scene, study.initial, study.sampling,
                                              reference.record, sweep, tick)) {
      timed.push_back({std::move(each.row), each.seconds});
    }
  }
}

int interrupted_exit() {
  fmt::print(stderr, "bounce: interrupted; nothing was written\n");
  return exit_interrupted;
}

int accuracy(const Options& options, const std::string& command_line) {
  const Study study = make_study(options);
  RunDirectory directory(options.directory(), options.force, "accuracy.csv");
  catch_interrupts();
  Reference reference;
  std::optional<std::vector<AccuracyRow>> rows;
  try {
    reference = make_reference(study);
    rows = run_all(study, reference, options.threads);
  } catch (const Stopped&) {
  } catch (const ReferenceError& error) {
    throw InputError(fmt::format("this scene has no reference: {}", error.what()));
  }
  if (!rows) return interrupted_exit();
  const CourseTimes times = time_courses(study.scene, study.initial, study.sampling, *rows, true);
  std::vector<TimedRow> timed;
  PapersProgram papers;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const AccuracyRow& row = (*rows)[i];
    if (row.setting == study.papers) papers = {i, times.oracle * static_cast<double>(row.steps)};
    timed.push_back({row, times.rows[i]});
  }
  try {
    add_baselines(options, study, reference, timed);
  } catch (const Stopped&) {
    return interrupted_exit();
  }
  const std::string table = accuracy_table(timed, papers, reference.record, reference.bar);
  write_file_whole(directory.path() / "scene.toml", to_toml(study.scene));
  write_file_whole(directory.path() / "accuracy.csv",
                   accuracy_csv(timed, reference.record, reference.bar));
  write_file_whole(directory.path() / "table.txt", table);
  Json origin = origin_json(options, study, command_line);
  origin["oracle_seconds"] = papers.seconds;
  if (const auto best = cheapest_as_good(timed, papers, reference.bar)) {
    const Setting& setting = timed[*best].row.setting;
    origin["best"] = {{"method", setting.method},
                      {"contact", std::string(contact_name(timed[*best].row))},
                      {"dt", timed[*best].row.step},
                      {"seconds", timed[*best].seconds}};
  }
  write_file_whole(directory.path() / "origin.json", origin.dump(2) + "\n");
  directory.publish();
  fmt::print("{}\nfiles: {}\n", table, options.directory().string());
  return 0;
}

}  // namespace

void add_accuracy_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "accuracy", "Measure error against run time, by method, contact rule and time step");
  command->add_option("SCENE", options->scene, "A scene's name, or a file")->required();
  add_set_option(*command, options->settings);
  command->add_option("--initial", options->initial, "Start from this state (CSV)");
  command->add_option("--methods", options->methods, "These methods and baselines [all]")
      ->delimiter(',');
  command->add_option("--every", options->every, "Time between two looks, s [0.01]");
  command->add_option("--decades", options->decades,
                      "Time steps from the stable one down so many decades [3]");
  command->add_option("--per-decade", options->per_decade, "Time steps a decade [3]");
  command->add_flag("--quick", options->quick, "1.5 decades, 2 a decade");
  command->add_option("--threads", options->threads,
                      "Courses side by side, 1 to 256; 0: one a core [0]");
  command->add_option("--out", options->out, "Directory of results [runs/SCENE-accuracy]");
  command->add_flag("--force", options->force, "Replace results that exist");
  command->footer(
      "Writes accuracy.csv, table.txt, scene.toml, origin.json. Errors are differences from a\n"
      "reference: two solutions in continuous time that share neither method nor arithmetic; what\n"
      "they differ by is its error bar.\n"
      "Examples:\n"
      "  bounce accuracy example-1 --quick\n"
      "  bounce accuracy example-2 --methods listing,leapfrog --set time.end=9\n");
  command->callback(
      [options, &context] { context.exit_code = accuracy(*options, context.command_line); });
}

}  // namespace bounce
