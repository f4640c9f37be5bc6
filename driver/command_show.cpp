// bounce show: a scene as it would run.
#include <memory>

#include <fmt/format.h>

#include "driver/scene/scene_file.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"

namespace bounce {

void add_show_command(CLI::App& program, CommandContext&) {
  struct Options {
    std::string scene;
    std::vector<std::string> settings;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("show", "Print a scene with all its values, as TOML");
  command->add_option("SCENE", options->scene, "Built-in scene or scene file")->required();
  add_set_option(*command, options->settings);
  command->footer(
      "Examples:\n"
      "  bounce show example-2\n"
      "  bounce show example-2 --set law.elasticity=4000 > my-ball.toml\n");
  command->callback([options] {
    SceneFile file = SceneFile::find(options->scene);
    for (const std::string& setting : options->settings) file.set(setting);
    print_out("{}", to_toml(file.scene()));
  });
}

}  // namespace bounce
