// bounce advise: the cheapest method, step and contact that reach an asked error.
#include <memory>

#include <fmt/format.h>

#include "driver/run/advice_text.hpp"
#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/limits.hpp"
#include "driver/world/shell_word.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

struct Options {
  std::string scene;
  std::vector<std::string> settings;
  std::string initial;
  AdviceRequest request;
};

// The command that runs it, to be pasted.
std::string run_text(const Options& options, const Advice& advice) {
  std::string text = "bounce run " + shell_word(options.scene);
  for (const std::string& setting : options.settings) text += " --set " + shell_word(setting);
  if (!options.initial.empty()) text += " --initial " + shell_word(options.initial);
  for (const std::string& setting : settings_of(advice, options.request.scene)) {
    text += " --set " + setting;
  }
  return text;
}

int advise_on(Options& options) {
  SceneFile file = SceneFile::find(options.scene);
  for (const std::string& setting : options.settings) file.set(setting);
  if (!options.initial.empty()) file.note_origin("initial state", options.initial);
  check_memory(file, "auto", available_memory());
  options.request.initial = load_start(options.initial);
  load_problem(file, options.request.initial);  // throws what is wrong with it
  check_threads(options.request.threads);
  options.request.scene = file.scene();
  catch_interrupts();
  const auto advice = ask_advice(options.request);
  if (!advice) {
    print_err("bounce: interrupted\n");
    return interrupt_exit_code();
  }
  print_out("{}\n", describe(*advice, options.request));
  print_out("\n  {}\n", run_text(options, *advice));
  return 0;
}

}  // namespace

void add_advise_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "advise", "Find the cheapest method, step and contact that reach an asked error");
  command->add_option("SCENE", options->scene, "Built-in scene or scene file")->required();
  command->add_option("--error", options->request.error, "Asked error, in the observable's unit")
      ->required();
  command->add_option("--observable", options->request.observable,
                      "height, speed, rebound, contact_time, energy_lost, flattening or position "
                      "(largest of a particle just before the impact) [height]");
  add_set_option(*command, options->settings);
  command->add_option("--initial", options->initial, "Start from this state");
  command->add_option("--threads", options->request.threads,
                      "For the search, 1 to 256; 0: one a core [0]");
  command->footer(
      "It runs the scene some hundred times with large steps, and compares with a fine run: 15\n"
      "to 30 seconds for the paper's examples.\n"
      "Examples:\n"
      "  bounce advise example-1 --error 1e-3\n"
      "  bounce advise example-2 --error 1e-2 --observable energy_lost\n"
      "  bounce run example-1 --error 1e-3              (asks, and runs it)\n");
  command->callback([options, &context] { context.exit_code = advise_on(*options); });
}

}  // namespace bounce
