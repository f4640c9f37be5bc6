// The commands of the program `bounce`, one file each.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "driver/world/invocation.hpp"

namespace bounce {

/// What the commands share with main().
struct CommandContext {
  std::string command_line;
  int exit_code = 0;
  Invocation asked{};
};

// Each adds its subcommand to the program; the callback runs when the user names it. Adding a
// command adds its declaration here and its line in main.cpp.
void add_list_command(CLI::App& program, CommandContext& context);
void add_show_command(CLI::App& program, CommandContext& context);
void add_run_command(CLI::App& program, CommandContext& context);
void add_resume_command(CLI::App& program, CommandContext& context);
void add_stability_command(CLI::App& program, CommandContext& context);
void add_reference_command(CLI::App& program, CommandContext& context);
void add_accuracy_command(CLI::App& program, CommandContext& context);
void add_advise_command(CLI::App& program, CommandContext& context);
void add_extremes_command(CLI::App& program, CommandContext& context);
void add_verify_command(CLI::App& program, CommandContext& context);

/// Adds --set key=value, which may be given several times.
void add_set_option(CLI::App& command, std::vector<std::string>& settings);

}  // namespace bounce
