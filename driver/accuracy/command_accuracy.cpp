// bounce accuracy: error against run time of one scene, by method, contact rule and time step.
#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/accuracy/accuracy_study.hpp"
#include "driver/accuracy/accuracy_table.hpp"
#include "driver/accuracy/reference_journal.hpp"
#include "driver/output/journal.hpp"
#include "driver/output/run_directory.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/scene/scene_keys.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/origin.hpp"
#include "driver/world/progress.hpp"
#include "kernels/model/method.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/accuracy/accuracy.hpp"
#include "verify/accuracy/baseline.hpp"
#include "verify/accuracy/course_timing.hpp"
#include "verify/accuracy/reference_pair.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
  StudyRequest study;
  int threads = 0;
  std::string out;
  bool force = false;

  [[nodiscard]] fs::path directory() const {
    return out.empty() ? fs::path("runs") / (fs::path(study.scene).stem().string() + "-accuracy")
                       : fs::path(out);
  }
};

// Ctrl-C, within the reference.
struct Stopped {};

// The course, and how far others are from it that claim to be the same: another method's, and that
// from a start some roundings away. (Where everything grows, in a collapse or when elastic walls
// are hit again and again, two courses may end alike by chance.)
struct Reference {
  CourseRecord record;
  CourseErrors bar;
};

CourseRecord seen(const Problem& problem, const ReferencePath& path, std::size_t free_samples) {
  CourseGauge gauge(problem, free_samples);
  for (const State& state : path.states) {
    if (!gauge.add(state)) break;
  }
  return gauge.result(path.bounce);
}

Reference make_reference(const Study& study, Journal& journal) {
  const Problem problem =
      problem_of(study.scene, study.initial, {"listing", Contact::resolved, 1}, study.sampling);
  std::vector<double> times;
  for (std::int64_t s = 0; s <= study.sampling.samples; ++s) {
    times.push_back(study.sampling.every * static_cast<double>(s));
  }
  const DisturbedPair paths = solve_disturbed(
      problem, times, {}, rounding_disturbance(problem),
      [] {
        if (interrupted()) throw Stopped();
      },
      kept_in(journal));
  const ReferencePair& pair = paths.pair;
  const std::size_t last = pair.last_before_contact();
  Reference reference;
  reference.record = seen(problem, pair.fixed, last > 0 ? last + 1 : 0);
  const auto distance_of = [&](const ReferencePath& path) {
    return bar_of(seen(problem, path, reference.record.free_samples), reference.record);
  };
  reference.bar = larger_of(distance_of(pair.adaptive), distance_of(paths.disturbed));
  return reference;
}

Json origin_json(const Options& options, const Study& study, const std::string& command) {
  const Origin origin = find_origin();
  return {{"scene", options.study.scene},  {"command", command},
          {"every", study.sampling.every}, {"end", study.sampling.end()},
          {"left_out", study.left_out},    {"version", origin.version},
          {"commit", origin.commit},       {"compiler", origin.compiler},
          {"flags", origin.flags},         {"cpu", origin.cpu},
          {"cores", origin.cores},         {"date", origin.date}};
}

std::string key_of(const Setting& setting) {
  return fmt::format("{} {} {}", setting.method, word_of(setting.contact), setting.steps_a_sample);
}

// All settings; those that the journal has are not run.
std::optional<std::vector<AccuracyRow>> run_all(const Study& study, const Reference& reference,
                                                int threads, Journal& journal) {
  double work = 0.0, done = 0.0;
  const auto work_of = [&](const Setting& s) {
    return static_cast<double>(s.steps_a_sample * find_method(s.method)->evaluations);
  };
  std::map<std::string, AccuracyRow> rows;
  std::vector<Setting> missing;
  for (const Setting& setting : study.settings) {
    if (auto row = journal.find<AccuracyRow>(key_of(setting))) {
      rows[key_of(setting)] = std::move(*row);
      continue;
    }
    missing.push_back(setting);
    work += work_of(setting);
  }
  CaseProgress progress(::isatty(STDERR_FILENO) != 0, missing.size(), work);
  std::size_t ended = 0;
  const auto measured =
      measure_accuracy(study.scene, study.initial, missing, study.sampling, reference.record,
                       threads, [&](std::size_t i, const AccuracyRow& row) {
                         journal.add(key_of(row.setting), row);
                         done += work_of(missing[i]);
                         progress.update(++ended, done);
                         return !interrupted();
                       });
  if (!measured) return std::nullopt;
  for (const AccuracyRow& row : *measured) rows[key_of(row.setting)] = row;
  std::vector<AccuracyRow> all;
  for (const Setting& setting : study.settings) all.push_back(rows.at(key_of(setting)));
  return all;
}

// The baselines, one course at a time: they are timed as they run.
void add_baselines(const StudyRequest& request, const Study& study, const Reference& reference,
                   Journal& journal, std::vector<TimedRow>& timed) {
  BaselineSweep sweep;
  if (request.quick) sweep = {2, 10.0, 0.1};
  for (const Baseline& baseline : baselines()) {
    if (!request.wants(baseline.name)) continue;
    if (study.scene.walls.empty() && baseline.contact == BaselineContact::listing) continue;
    const auto tick = [] {
      if (interrupted()) throw Stopped();
    };
    const std::string key = fmt::format("{} {}", baseline.name, static_cast<int>(baseline.contact));
    auto rows = journal.find<std::vector<BaselineRow>>(key);
    if (!rows) {
      rows = measure_baseline(baseline, study.scene, study.initial, study.sampling,
                              reference.record, sweep, tick);
      journal.add(key, *rows);
    }
    for (BaselineRow& each : *rows) timed.push_back({std::move(each.row), each.seconds});
  }
}

// What each case depends on beside its name.
std::string task_of(const Study& study, bool quick) {
  const Json json{
      {"scene", to_toml(study.scene)},
      {"initial",
       study.initial ? Json(fmt::format("{:016x}", state_hash(*study.initial))) : Json()},
      {"every", study.sampling.every},
      {"samples", study.sampling.samples},
      {"quick", quick}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

int accuracy(const Options& options, const CommandContext& context) {
  check_threads(options.threads);
  choose_vector("auto");  // throws on a processor that BondForces is not compiled for
  catch_interrupts();
  RunDirectory directory(options.directory(), options.force, "accuracy.csv");
  const Study study = make_study(options.study);
  Journal journal(options.directory(), context.asked, task_of(study, options.study.quick),
                  options.force);
  // The reference's three solutions, the settings, the baselines.
  const std::size_t cases = 3 + study.settings.size() + baselines().size();
  const auto stopped = [&] {
    say_stopped(journal.size(), cases, journal, options.directory());
    return interrupt_exit_code();
  };
  say_going_on(journal.size(), cases);
  Reference reference;
  std::optional<std::vector<AccuracyRow>> rows;
  try {
    reference = make_reference(study, journal);
    rows = run_all(study, reference, options.threads, journal);
  } catch (const Stopped&) {
  } catch (const ReferenceError& error) {
    journal.finish();
    throw InputError(fmt::format("this scene has no reference: {}", error.what()));
  }
  if (!rows) return stopped();
  const CourseTimes times = time_courses(study.scene, study.initial, study.sampling, *rows, true);
  std::vector<TimedRow> timed;
  PapersProgram papers;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const AccuracyRow& row = (*rows)[i];
    if (study.papers && row.setting == *study.papers)
      papers = {i, times.oracle * static_cast<double>(row.steps)};
    timed.push_back({row, times.rows[i]});
  }
  try {
    add_baselines(options.study, study, reference, journal, timed);
  } catch (const Stopped&) {
    return stopped();
  }
  std::string table = accuracy_table(timed, papers, reference.record, reference.bar);
  for (const std::string& line : study.left_out) table += fmt::format("left out: {}\n", line);
  write_file_whole(directory.path() / "scene.toml", to_toml(study.scene));
  write_file_whole(directory.path() / "accuracy.csv",
                   accuracy_csv(timed, reference.record, reference.bar));
  write_file_whole(directory.path() / "table.txt", table);
  Json origin = origin_json(options, study, context.command_line);
  origin["oracle_seconds"] = papers.seconds;
  if (const auto best = cheapest_as_good(timed, papers, reference.bar)) {
    const AccuracyRow& row = timed[*best].row;
    origin["best"] = {{"method", row.setting.method},
                      {"contact", std::string(contact_name(row))},
                      {"dt", row.step},
                      {"seconds", timed[*best].seconds}};
  }
  write_file_whole(directory.path() / "origin.json", origin.dump(2) + "\n");
  directory.publish();
  journal.finish();
  print_out("{}\nfiles: {}\n", table, options.directory().string());
  return 0;
}

}  // namespace

void add_accuracy_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "accuracy", "Measure error against run time, by method, contact rule and time step");
  command->add_option("SCENE", options->study.scene, "A scene's name, or a file")->required();
  add_set_option(*command, options->study.settings);
  command->add_option("--initial", options->study.initial, "Start from this state (CSV)");
  command->add_option("--methods", options->study.methods, "These methods and baselines [all]")
      ->delimiter(',');
  command
      ->add_option("--contacts", options->study.contacts,
                   "These of a method's contacts: listing, resolved, located [all]")
      ->delimiter(',');
  command
      ->add_option("--steps", options->study.steps,
                   "These time steps, too, s; whole parts of --every [none]")
      ->delimiter(',');
  command->add_option("--every", options->study.every, "Time between two looks, s [0.01]");
  command->add_option(
      "--decades", options->study.sweep.decades,
      "Time steps from the stable one down so many decades, one less for methods above order 2 "
      "with located contact [3]");
  command->add_option("--per-decade", options->study.sweep.per_decade,
                      "Time steps a decade, in the first four times as many [3]");
  command->add_flag("--quick", options->study.quick, "1.5 decades, 2 a decade, in the first, too");
  command->add_option("--threads", options->threads,
                      "Courses side by side, 1 to 256; 0: one a core [0]");
  command->add_option("--out", options->out, "Directory of results [runs/SCENE-accuracy]");
  command->add_flag("--force", options->force, "Replace results that exist");
  command->footer(
      "Writes accuracy.csv, table.txt, scene.toml, origin.json. Errors are differences from a\n"
      "reference: solutions in continuous time by two methods that share no arithmetic, and one "
      "from\n"
      "a start some roundings away; what they differ by is its error bar.\n"
      "Examples:\n"
      "  bounce accuracy example-1 --quick\n"
      "  bounce accuracy example-2 --methods listing,leapfrog --set time.end=9\n");
  command->callback([options, &context] { context.exit_code = accuracy(*options, context); });
}

}  // namespace bounce
