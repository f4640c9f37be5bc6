// bounce list: what there is to choose from.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/scene/built_in_scenes.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "kernels/model/method.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/oracle/oracle_stepper.hpp"

namespace bounce {
namespace {

void list() {
  print_out("Scenes (bounce run NAME):\n");
  for (const BuiltInScene& scene : built_in_scenes()) {
    print_out("  {:<12} {}\n", scene.name, SceneFile::find(std::string(scene.name)).scene().title);
  }
  print_out("\nMethods (--set time.method=NAME):\n");
  for (const Method& method : methods()) {
    print_out("  {:<13} {} (order {}, {} force evaluation(s) a step)\n", method.name,
              method.description, method.order, method.evaluations);
  }
  print_out("\nKernels (--kernel NAME):\n");
  for (const KernelEntry& kernel : kernels_with_oracle(Scene{})) {
    print_out("  {:<12} {}{}\n", kernel.name, kernel.description,
              kernel.automatic ? "" : " (only if asked for)");
  }
  print_out("\nVector targets of this machine (--vector NAME):\n");
  for (const VectorTarget target : available_vectors()) print_out("  {}\n", name_of(target));
  print_out("\nKeys of a scene (--set KEY=VALUE):\n  {}\n", fmt::join(scene_key_names(), "\n  "));
}

}  // namespace

void add_list_command(CLI::App& program, CommandContext&) {
  program.add_subcommand("list", "List scenes, methods, kernels, vector targets and scene keys")
      ->callback(list);
}

}  // namespace bounce
