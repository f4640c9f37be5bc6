// bounce list: what there is to choose from.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/scene/built_in_scenes.hpp"
#include "driver/world/commands.hpp"
#include "driver/scene/scene_file.hpp"
#include "kernels/model/method.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/oracle/oracle_stepper.hpp"

namespace bounce {
namespace {

void list() {
  fmt::print("Scenes (bounce run NAME):\n");
  for (const BuiltInScene& scene : built_in_scenes()) {
    fmt::print("  {:<12} {}\n", scene.name, SceneFile::find(std::string(scene.name)).scene().title);
  }
  fmt::print("\nMethods (--set time.method=NAME):\n");
  for (const Method& method : methods()) {
    fmt::print("  {:<13} {} (order {}, {} force evaluation(s) a step)\n", method.name,
               method.description, method.order, method.evaluations);
  }
  fmt::print("\nKernels (--kernel NAME):\n");
  for (const KernelEntry& kernel : kernels_with_oracle(Scene{})) {
    fmt::print("  {:<12} {}{}\n", kernel.name, kernel.description,
               kernel.automatic ? "" : " (only if asked for)");
  }
  fmt::print("\nVector targets of this machine (--vector NAME):\n");
  for (const VectorTarget target : available_vectors()) fmt::print("  {}\n", name_of(target));
  fmt::print("\nKeys of a scene (--set KEY=VALUE):\n  {}\n", fmt::join(scene_key_names(), "\n  "));
}

}  // namespace

void add_list_command(CLI::App& program, CommandContext&) {
  program.add_subcommand("list", "List scenes, methods, kernels, vector targets and scene keys")
      ->callback(list);
}

}  // namespace bounce
