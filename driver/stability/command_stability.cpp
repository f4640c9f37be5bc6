// bounce stability: the largest stable time step of a scene, computed or measured.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "driver/output/journal.hpp"
#include "driver/output/run_directory.hpp"
#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/scene/step_check.hpp"
#include "driver/stability/edge_row.hpp"
#include "driver/stability/edge_sweep.hpp"
#include "driver/stability/edge_table.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/limits.hpp"
#include "driver/world/origin.hpp"
#include "driver/world/progress.hpp"
#include "kernels/model/method.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

using Json = nlohmann::ordered_json;

namespace fs = std::filesystem;

// The file by which the directory of a sweep is known.
constexpr const char* marker = "edge.csv";

struct Options {
  std::string scene;
  std::vector<std::string> settings;
  std::string initial;
  bool predict = false;
  bool json = false;
  // Of measuring:
  std::vector<double> elasticities;
  std::optional<double> e_from, e_to;
  std::optional<int> count;
  std::optional<double> step;
  std::vector<std::string> methods;
  std::optional<std::vector<double>> speeds, gravities, disturbances;
  bool flight_only = false;
  bool undisturbed = false;
  bool quick = false;
  EdgeCriterion criterion;
  int threads = 0;
  std::string out;
  bool force = false;

  [[nodiscard]] fs::path directory() const {
    return out.empty() ? fs::path("runs") / (fs::path(scene).stem().string() + "-stability")
                       : fs::path(out);
  }
};

// A scene ready for either way of finding its edge.
struct Case {
  SceneFile file;
  std::optional<State> initial;
  Problem problem;
};

// `runs`: whether it is to be run, which takes more memory than what is predicted from.
Case load_case(const Options& options, bool runs) {
  SceneFile file = SceneFile::find(options.scene);
  for (const std::string& setting : options.settings) file.set(setting);
  if (!options.initial.empty()) file.note_origin("initial state", options.initial);
  if (runs) check_memory(file, "auto", available_memory());
  std::optional<State> initial = load_start(options.initial);
  Problem problem = load_problem(file, initial);
  return {std::move(file), std::move(initial), std::move(problem)};
}

// JSON has no infinity: the stable step of a ball in which nothing vibrates is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

std::string prediction_json(const Options& options, const Problem& problem,
                            const StepCheck& check) {
  const FastestVibration& fastest = check.fastest;
  Json json{{"scene", options.scene},
            {"initial", options.initial.empty() ? Json() : Json(options.initial)},
            {"particles", problem.initial.size()},
            {"omega_max", fastest.omega},
            {"omega_max_from", fastest.exact ? "lanczos" : "bound"},
            {"omega_max_bound", std::sqrt(fastest.bound.lambda)}};
  for (const Method& method : methods()) {
    const std::string name(method.name);
    json["limit"][name] = stability_limit(method);
    json["stable_step"][name] = number(stable_step(method, fastest.omega));
  }
  json["method"] = std::string(problem.method->name);
  json["dt"] = problem.step;
  json["part"] = check.part;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_prediction(const Problem& problem, const StepCheck& check) {
  const FastestVibration& fastest = check.fastest;
  if (fastest.exact) {
    print_out("omega_max: {:.8g} 1/s (largest eigenvalue of the bond energy's Hessian, Lanczos)\n",
              fastest.omega);
  } else {
    print_out("omega_max: {:.8g} 1/s (by the bound; the ball is too large for Lanczos)\n",
              fastest.omega);
  }
  print_out("its bound: {:.8g} 1/s\n\n", std::sqrt(fastest.bound.lambda));
  print_out("{:<14} {:>22} {:>15}\n", "method", "limit of omega_max dt", "stable step, s");
  for (const Method& method : methods()) {
    print_out("{:<14} {:>22.6g} {:>15.6g}\n", method.name, stability_limit(method),
              stable_step(method, fastest.omega));
  }
  print_out("\ntime step: {:.6g} s, {:.3g} of the stable step of {}\n", problem.step, check.part,
            problem.method->name);
}

// Throws InputError if a stiffness at the start is not finite.
StepCheck check_start(const Case& it) {
  const auto check = check_step(it.problem);
  if (check) return *check;
  throw it.file.explain(SceneError("initial state", "a bond without a finite stiffness",
                                   "particles apart from each other"));
}

// What the stiffness at the start tells.
void predict(const Options& options) {
  const Case it = load_case(options, false);
  const StepCheck check = check_start(it);
  if (options.json) {
    print_out("{}", prediction_json(options, it.problem, check));
  } else {
    print_prediction(it.problem, check);
  }
}

// Throws InputError unless the value of an option is above `least`, or at it if that is allowed.
void demand(const std::string& option, double value, double least, bool least_too = false) {
  if (std::isfinite(value) && (value > least || (least_too && value == least))) return;
  throw InputError(fmt::format("{} {}: allowed is a number {} {}", option, value,
                               least_too ? "from" : "above", least));
}

std::vector<double> elasticities_of(const Options& options) {
  if (!options.elasticities.empty()) {
    for (const double e : options.elasticities) demand("--e", e, 0.0);
    return options.elasticities;
  }
  const double from = options.e_from.value_or(options.quick ? 1e3 : 1e1);
  const double to = options.e_to.value_or(1e9);
  const int count = options.count.value_or(options.quick ? 3 : 17);
  demand("--e-from", from, 0.0);
  demand("--e-to", to, from, true);
  if (count < 1 || count > 10'000) {
    throw InputError(fmt::format("--count {}: allowed is 1 to 10000", count));
  }
  return elasticity_range(from, to, count);
}

std::vector<std::string> methods_of(const Options& options) {
  std::vector<std::string> all;
  for (const Method& method : methods()) all.emplace_back(method.name);
  for (const std::string& name : options.methods) {
    if (find_method(name) == nullptr) {
      throw InputError(
          fmt::format("--methods {}: unknown; allowed is {}", name, fmt::join(all, ", ")));
    }
  }
  return options.methods.empty() ? all : options.methods;
}

SweepRequest request_of(const Options& options, const Case& it) {
  SweepRequest request;
  request.scene = it.file.scene();
  request.initial = it.initial;
  request.methods = methods_of(options);
  request.elasticities = elasticities_of(options);
  request.step = options.step.value_or(request.scene.time.step);
  demand("--dt", request.step, 0.0);
  using List = std::vector<double>;
  request.speeds = options.speeds.value_or(options.quick ? List{} : List{1, 3, 10, 30});
  request.gravities = options.gravities.value_or(options.quick ? List{} : List{0, 0.98, 9.8, 98});
  request.disturbances = options.disturbances.value_or(
      options.quick || options.undisturbed ? List{} : List{1e-3, 3e-3, 1e-2, 2e-2, 3e-2});
  for (const double size : request.disturbances) demand("--disturbed", size, 0.0);
  for (const double speed : request.speeds) demand("--speed", speed, 0.0);
  for (const double g : request.gravities) demand("--g", g, 0.0, true);
  request.flight_only = options.flight_only;
  request.criterion = options.criterion;
  demand("--growth", request.criterion.growth, 0.0);
  demand("--periods", request.criterion.periods, 0.0);
  check_threads(options.threads);
  return request;
}

Json origin_json(const Options& options, const SweepRequest& request, const std::string& command) {
  const Origin origin = find_origin();
  return {{"scene", options.scene},
          {"command", command},
          {"growth", request.criterion.growth},
          {"periods", request.criterion.periods},
          {"bracket_ratio", edge_ratio},
          {"version", origin.version},
          {"commit", origin.commit},
          {"compiler", origin.compiler},
          {"flags", origin.flags},
          {"cpu", origin.cpu},
          {"cores", origin.cores},
          {"date", origin.date}};
}

// What a stopped sweep must have in common with one that goes on with its rows.
std::string task_of(const std::vector<SweepCase>& cases, const SweepRequest& request) {
  Json json{{"scene", to_toml(request.scene)},
            {"initial",
             request.initial ? Json(fmt::format("{:016x}", state_hash(*request.initial))) : Json()},
            {"cases", Json::array()}};
  for (const SweepCase& each : cases) json["cases"].push_back(each.key);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Work to expect of a case, in steps.
double expected_work(const SweepCase& each, const EdgeCriterion& usual) {
  if (each.edge.passage == Passage::bounce) return 3e5;
  // Bisected, or climbed to.
  const bool longer = each.edge.criterion.periods > usual.periods;
  const bool climbed = longer || each.edge.disturbance != edge_disturbance;
  const double runs = climbed ? 40.0 : 8.0;
  return runs * 3.0 * each.edge.criterion.periods;
}

// Cases that are measured side by side: the next of one method and passage, so many at most that a
// stopped sweep loses little.
std::span<const SweepCase> next_together(std::span<const SweepCase> rest) {
  constexpr std::size_t most = 16;
  std::size_t n = 1;
  while (n < std::min(most, rest.size()) && rest[n].edge.passage == rest[0].edge.passage &&
         rest[n].edge.scene.time.method == rest[0].edge.scene.time.method) {
    ++n;
  }
  return rest.first(n);
}

// Measures what is not there and adds it. False if it was interrupted.
bool measure_missing(const std::vector<SweepCase>& cases, const Options& options, Journal& journal,
                     std::map<std::string, std::string>& rows) {
  std::vector<SweepCase> missing;
  double work = 0.0;
  for (const SweepCase& each : cases) {
    if (rows.contains(each.key)) continue;
    missing.push_back(each);
    work += expected_work(each, options.criterion);
  }
  CaseProgress progress(::isatty(STDERR_FILENO) != 0, missing.size(), work);
  double done = 0.0;
  TrialOptions trials;
  trials.threads = options.threads;
  trials.stop = interrupted;
  for (std::span<const SweepCase> rest = missing; !rest.empty();) {
    const auto now = next_together(rest);
    const auto start = std::chrono::steady_clock::now();
    std::vector<EdgeCase> edges;
    for (const SweepCase& each : now) edges.push_back(each.edge);
    const auto measured = measure_edges(edges, trials);
    if (!measured) return false;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    double steps = 0.0;
    for (const Edge& edge : *measured) steps += static_cast<double>(edge.steps);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Edge& edge = (*measured)[i];
      const double share = steps > 0.0 ? static_cast<double>(edge.steps) / steps : 0.0;
      const std::string line = edge_line(now[i].key, edge, seconds * share);
      journal.add(now[i].key, line);
      rows[now[i].key] = line;
      done += expected_work(now[i], options.criterion);
    }
    rest = rest.subspan(now.size());
    progress.update(missing.size() - rest.size(), done);
  }
  return true;
}

int measure(const Options& options, const CommandContext& context) {
  RunDirectory directory(options.directory(), options.force, marker);
  const Case it = load_case(options, true);
  check_start(it);
  const SweepRequest request = request_of(options, it);
  const std::vector<SweepCase> cases = make_sweep(request);
  Journal journal(options.directory(), context.asked, task_of(cases, request), options.force);
  std::map<std::string, std::string> rows;
  for (const SweepCase& each : cases) {
    if (const auto line = journal.find<std::string>(each.key)) rows[each.key] = *line;
  }
  catch_interrupts();
  say_going_on(rows.size(), cases.size());
  if (!measure_missing(cases, options, journal, rows)) {
    say_stopped(rows.size(), cases.size(), journal, options.directory());
    return interrupt_exit_code();
  }
  std::string csv = edge_header;
  std::vector<EdgeRow> table;
  for (const SweepCase& each : cases) {
    csv += rows.at(each.key) + "\n";
    table.push_back(read_edge_line(rows.at(each.key)).value());
  }
  const std::string text = edge_table(table, request.scene.law.elasticity, request.criterion);
  write_file_whole(directory.path() / "scene.toml", to_toml(request.scene));
  write_file_whole(directory.path() / "edge.csv", csv);
  write_file_whole(directory.path() / "table.txt", text);
  write_file_whole(directory.path() / "origin.json",
                   origin_json(options, request, context.command_line).dump(2) + "\n");
  directory.publish();
  journal.finish();
  print_out("{}\nfiles: {}\n", text, options.directory().string());
  return 0;
}

void add_measuring_options(CLI::App& command, Options& options, CLI::Option* predict) {
  const auto measuring = [predict](CLI::Option* option) { return option->excludes(predict); };
  auto* list = measuring(command.add_option("--e", options.elasticities, "These values of E"));
  list->delimiter(',');
  measuring(command.add_option("--e-from", options.e_from, "Least E [10]"))->excludes(list);
  measuring(command.add_option("--e-to", options.e_to, "Greatest E [1e9]"))->excludes(list);
  measuring(command.add_option("--count", options.count, "Number of values of E [17]"))
      ->excludes(list);
  measuring(command.add_option("--dt", options.step,
                               "Time step at which the largest E is sought, s [the scene's]"));
  measuring(command.add_option("--methods", options.methods, "These methods [all]"))
      ->delimiter(',');
  measuring(command.add_option("--speed", options.speeds,
                               "Speeds of impact at the scene's E, cm/s [1,3,10,30]"))
      ->delimiter(',');
  measuring(command.add_option("--g", options.gravities,
                               "Gravities at the scene's E and speed of impact, cm/s^2 "
                               "[0,0.98,9.8,98]"))
      ->delimiter(',');
  auto* sizes =
      measuring(command.add_option("--disturbed", options.disturbances,
                                   "Disturbances of flights at the scene's E, in shortest bonds "
                                   "[0.001,0.003,0.01,0.02,0.03]"));
  sizes->delimiter(',');
  measuring(command.add_flag("--no-disturbed", options.undisturbed, "None of those"))
      ->excludes(sizes);
  measuring(command.add_flag("--flight-only", options.flight_only, "Leave the bounces out"));
  measuring(command.add_flag("--quick", options.quick,
                             "3 values of E from 1000, no other speeds, gravities, disturbances"));
  measuring(command.add_option("--growth", options.criterion.growth,
                               "Unstable: energy gained, in what the ball had [100]"));
  measuring(command.add_option("--periods", options.criterion.periods,
                               "Length of a flight in periods of the fastest vibration [1000]"));
  measuring(command.add_option("--threads", options.threads, "1 to 256; 0: one a core [0]"));
  measuring(command.add_option("-o,--out", options.out,
                               "Directory of the results [runs/SCENE-stability]"));
  measuring(command.add_flag("--force", options.force,
                             "Replace results that exist, or drop a stopped sweep with other "
                             "arguments"));
}

}  // namespace

void add_stability_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("stability", "Find the largest stable time step of a scene");
  command->add_option("SCENE", options->scene, "Built-in scene (see bounce list) or scene file")
      ->required();
  add_set_option(*command, options->settings);
  command->add_option("--initial", options->initial,
                      "Look at the state in FILE: the listing's format, or the CSV of "
                      "bounce run's --final-state");
  auto* predict_flag =
      command->add_flag("--predict", options->predict,
                        "Only compute it, from the stiffness at the start and the methods' stages");
  command->add_flag("--json", options->json, "With --predict: print one JSON object")
      ->needs(predict_flag);
  add_measuring_options(*command, *options, predict_flag);
  command->footer(
      "A method is stable while omega_max dt stays below its limit; omega_max is the angular\n"
      "frequency of the ball's fastest vibration. Pressed bonds are stiffer: in an impact the "
      "edge\n"
      "comes nearer (bounce run reports how near, and monitor.csv has it in the column\n"
      "stable_part).\n"
      "The limit is where the first unstable step lies. Where that is the start of a narrow "
      "window\n"
      "(blanes-moan-4, blanes-moan-6) a flight of --periods may be stable beyond it: the edge\n"
      "predicted for the criterion is then another, and the limit is measured by longer flights.\n"
      "Without --predict the edge is measured: in free flight and through a bounce over E, at one\n"
      "time step the largest E, and over speed of impact and gravity. Results: edge.csv (a row a\n"
      "case), table.txt (as printed), origin.json, scene.toml. A sweep that is stopped goes on "
      "where\n"
      "it was when the same command is given again.\n"
      "Exit code: 0 done, 2 bad input, 130, 143 or 129\n"
      "stopped with Ctrl-C, SIGTERM or SIGHUP, 1 anything else.\n"
      "Examples:\n"
      "  bounce stability example-2 --predict\n"
      "  bounce stability example-2 --predict --json --set law.elasticity=1e6\n"
      "  bounce stability example-2\n"
      "  bounce stability example-2 --e 1000,16000 --methods leapfrog --flight-only --out edge\n"
      "  bounce stability example-1 --count 33 --speed 0.5,5,50\n");
  command->callback([options, &context] {
    if (options->predict) {
      predict(*options);
    } else {
      context.exit_code = measure(*options, context);
    }
  });
}

}  // namespace bounce
