// The program `bounce`: its commands, and what the world sees of an error.
#include <algorithm>
#include <exception>
#include <new>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/limits.hpp"
#include "driver/world/near_miss.hpp"
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

Invocation invocation(int argc, char** argv) {
  std::error_code ignored;
  return {{argv + std::min(argc, 1), argv + argc}, std::filesystem::current_path(ignored)};
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// Throws InputError if the first word is no command's name.
void check_command(const CLI::App& program, int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "-";
  const std::vector<std::string> names = command_names(program);
  if (word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end()) return;
  throw InputError(fmt::format("{}: no such command{} (allowed are: {})", word,
                               did_you_mean(word, names), fmt::join(names, ", ")));
}

// --help and --version are printed; an option that is unknown is named, whatever else is wrong.
int end_of_parsing(const CLI::App& program, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {
    std::ostringstream text;
    program.exit(error, text, text);
    write_out(text.str());
    return 0;
  }
  const auto used = program.get_subcommands();
  const CLI::App& command = used.empty() ? program : *used.front();
  const std::string help = "bounce " + (used.empty() ? "" : command.get_name() + " ") + "--help";
  for (const std::string& word : program.remaining(true)) {
    const std::string name = word.substr(0, word.find('='));
    if (!name.starts_with('-') || name.find_first_not_of('-') == std::string::npos) continue;
    throw InputError(fmt::format("{}: no such option{} ({} lists them)", name,
                                 did_you_mean(name, option_names(command)), help));
  }
  throw InputError(fmt::format("{} ({} says more)", error.what(), help));
}

int parse_and_run(int argc, char** argv) {
  CommandContext context{command_line(argc, argv), 0, invocation(argc, argv)};
  CLI::App program("bounce: Greenspan's particle model of a bouncing elastic ball", "bounce");
  program.set_version_flag("--version", version_text);
  program.require_subcommand(1);
  program.footer(
      "Start with: bounce list, bounce show example-2, bounce run example-2\n"
      "bounce COMMAND --help tells more of a command.");
  add_list_command(program, context);
  add_show_command(program, context);
  add_run_command(program, context);
  add_resume_command(program, context);
  add_stability_command(program, context);
  add_reference_command(program, context);
  add_accuracy_command(program, context);
  add_advise_command(program, context);
  add_extremes_command(program, context);
  add_verify_command(program, context);
  check_command(program, argc, argv);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_parsing(program, error);
  }
  return context.exit_code;
}

// A message may have several lines.
int report(std::string_view message, int code) {
  std::string text = "bounce: ";
  for (std::string_view rest = message; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    text += printable(rest.substr(0, end)) + "\n";
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  write_err(text);
  return code;
}

int main_with_errors(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const InputError& error) {
    return report(error.what(), 2);
  } catch (const SceneError& error) {
    return report(error.what(), 2);
  } catch (const PlanError& error) {
    // What may be asked of a plan are options of the same names.
    return report((error.field.empty() ? "" : "--") + std::string(error.what()), 2);
  } catch (const OutputError& error) {
    return report(error.what(), 4);
  } catch (const std::bad_alloc&) {
    return report("out of memory: the ball is too large for this machine", 1);
  } catch (const std::exception& error) {
    return report(error.what(), 1);
  }
}

}  // namespace
}  // namespace bounce

int main(int argc, char** argv) {
  bounce::guard_streams();
  bounce::limit_threads();
  return bounce::finish_output(bounce::main_with_errors(argc, argv));
}
