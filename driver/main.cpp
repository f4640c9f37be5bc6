// The program `bounce`: its commands, and what the world sees of an error.
#include <cstdio>
#include <exception>
#include <new>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/world/commands.hpp"
#include "driver/world/cores.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/origin.hpp"
#include "driver/world/shell_word.hpp"
#include "kernels/model/scene.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {

void add_set_option(CLI::App& command, std::vector<std::string>& settings) {
  command
      .add_option("--set", settings,
                  "Change a value of the scene, KEY=VALUE: law.elasticity=1000, "
                  "ball.radii=[10,11,12], wall.alpha=1 (every wall's), wall[1].alpha=0.5")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

namespace {

std::string version_text() {
  const Origin origin = find_origin();
  std::vector<std::string> vectors;
  for (const VectorTarget target : available_vectors()) vectors.emplace_back(name_of(target));
  return fmt::format("bounce {} (commit {})\n{} {}\nvector targets: {}", origin.version,
                     origin.commit, origin.compiler, origin.flags,
                     vectors.empty() ? "none" : fmt::format("{}", fmt::join(vectors, ", ")));
}

// As it could be typed again.
std::string command_line(int argc, char** argv) {
  std::string line = "bounce";
  for (int i = 1; i < argc; ++i) {
    line += " " + shell_word(argv[i]);
  }
  return line;
}

int parse_and_run(int argc, char** argv) {
  CommandContext context{command_line(argc, argv), 0};
  CLI::App program("bounce: Greenspan's particle model of a bouncing elastic ball", "bounce");
  program.set_version_flag("--version", version_text);
  program.require_subcommand(1);
  program.footer(
      "Start with: bounce list, bounce show example-2, bounce run example-2\n"
      "bounce COMMAND --help tells more of a command.");
  add_list_command(program, context);
  add_show_command(program, context);
  add_run_command(program, context);
  add_stability_command(program, context);
  add_reference_command(program, context);
  add_accuracy_command(program, context);
  add_advise_command(program, context);
  add_extremes_command(program, context);
  add_verify_command(program, context);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;  // 0: --help and --version
  }
  return context.exit_code;
}

int main_with_errors(int argc, char** argv) {
  const auto report = [](const char* what, int code) {
    fmt::print(stderr, "bounce: {}\n", what);
    return code;
  };
  try {
    return parse_and_run(argc, argv);
  } catch (const InputError& error) {
    return report(error.what(), 2);
  } catch (const SceneError& error) {
    return report(error.what(), 2);
  } catch (const PlanError& error) {
    // What may be asked of a plan are options of the same names.
    return report(((error.field.empty() ? "" : "--") + std::string(error.what())).c_str(), 2);
  } catch (const std::bad_alloc&) {
    return report("out of memory: the ball is too large for this machine", 1);
  } catch (const std::exception& error) {
    return report(error.what(), 1);
  }
}

}  // namespace
}  // namespace bounce

int main(int argc, char** argv) {
  bounce::limit_threads();
  return bounce::main_with_errors(argc, argv);
}
