// bounce stability: the largest stable time step of a scene.
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/commands.hpp"
#include "driver/load_problem.hpp"
#include "driver/scene_file.hpp"
#include "driver/step_check.hpp"
#include "kernels/stepping/method.hpp"
#include "verify/stability_limit.hpp"

namespace bounce {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string scene;
  std::vector<std::string> settings;
  std::string initial;
  bool predict = false;
  bool json = false;
};

// A scene ready for either way of finding its edge.
struct Case {
  SceneFile file;
  Problem problem;
};

Case load_case(const Options& options) {
  SceneFile file = SceneFile::find(options.scene);
  for (const std::string& setting : options.settings) file.set(setting);
  if (!options.initial.empty()) file.note_origin("initial state", options.initial);
  Problem problem = load_problem(file, options.initial);
  return {std::move(file), std::move(problem)};
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
    fmt::print("omega_max: {:.8g} 1/s (largest eigenvalue of the bond energy's Hessian, Lanczos)\n",
               fastest.omega);
  } else {
    fmt::print("omega_max: {:.8g} 1/s (by the bound; the ball is too large for Lanczos)\n",
               fastest.omega);
  }
  fmt::print("its bound: {:.8g} 1/s\n\n", std::sqrt(fastest.bound.lambda));
  fmt::print("{:<12} {:>22} {:>15}\n", "method", "limit of omega_max dt", "stable step, s");
  for (const Method& method : methods()) {
    fmt::print("{:<12} {:>22.6g} {:>15.6g}\n", method.name, stability_limit(method),
               stable_step(method, fastest.omega));
  }
  fmt::print("\ntime step: {:.6g} s, {:.3g} of the stable step of {}\n", problem.step, check.part,
             problem.method->name);
}

// What the stiffness at the start tells.
void predict(const Options& options) {
  const Case it = load_case(options);
  const auto check = check_step(it.problem);
  if (!check) {
    throw it.file.explain(SceneError("initial state", "a bond without a finite stiffness",
                                     "particles apart from each other"));
  }
  if (options.json) {
    fmt::print("{}", prediction_json(options, it.problem, *check));
  } else {
    print_prediction(it.problem, *check);
  }
}

}  // namespace

void add_stability_command(CLI::App& program, CommandContext&) {
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
                        "Compute it from the stiffness at the start and the methods' stage tables");
  predict_flag->required();
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "A method is stable while omega_max dt stays below its limit; omega_max is the angular\n"
      "frequency of the ball's fastest vibration. Pressed bonds are stiffer: in an impact the "
      "edge\n"
      "comes nearer (bounce run reports how near, and monitor.csv has it in the column\n"
      "stable_part).\n"
      "Examples:\n"
      "  bounce stability example-2 --predict\n"
      "  bounce stability example-2 --predict --json --set law.elasticity=1e6\n");
  command->callback([options] { predict(*options); });
}

}  // namespace bounce
