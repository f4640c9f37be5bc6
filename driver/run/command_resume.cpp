// bounce resume: goes on with a run that was stopped, or beyond the end of one that is complete.
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "driver/output/journal.hpp"
#include "driver/run/checkpoint.hpp"
#include "driver/run/run_job.hpp"
#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/scene/state_file.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/limits.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string directory;
  std::optional<double> end;
  std::optional<std::int64_t> steps;
  std::string vector;
  std::optional<int> threads;
  double checkpoint_every = usual_checkpoints;
  bool before = false;
  bool force = false;
  bool quiet = false;
};

// The scene, which must be the one of the checkpoint, with a later end if one is asked for.
SceneFile load_scene(const fs::path& folder, const Options& options, const CheckpointHead& head) {
  const std::string path = (folder / "scene.toml").string();
  SceneFile file = SceneFile::find(path);
  if (hash_of(file.scene()) != head.scene) {
    throw InputError(fmt::format(
        "{}: is not the scene of the checkpoint: it was changed; allowed is what the run wrote",
        path));
  }
  if (options.end) file.end_at(*options.end, "--t-end");
  if (options.steps) file.end_after(*options.steps, "--steps");
  const Scene scene = file.scene();
  if (scene.steps_until(scene.time.end) < head.step) {
    throw InputError(
        fmt::format("--t-end, --steps: allowed is an end from t = {:.9g} s (step {}) on, "
                    "where the run stands",
                    head.time, head.step));
  }
  return file;
}

std::optional<State> load_initial(const fs::path& folder, const RunSettings& settings) {
  if (settings.initial.empty()) return std::nullopt;
  return read_state((folder / "initial.csv").string()).state;
}

// A command that goes on when it is asked the same again: asks that. Does not return.
[[noreturn]] void ask_again(const Invocation& asked) {
  std::vector<std::string> words{"bounce"};
  words.insert(words.end(), asked.arguments.begin(), asked.arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  fs::current_path(asked.folder);
  ::execv("/proc/self/exe", arguments.data());
  throw std::system_error(errno, std::generic_category(), "the command cannot be started again");
}

int resume(const Options& options) {
  if (const auto asked = find_journal(options.directory)) ask_again(*asked);
  catch_interrupts();
  RunDirectory directory = RunDirectory::reopen(options.directory);
  const fs::path& folder = directory.path();
  RunJob job;
  job.from = load_checkpoint(folder, options.before, options.force);
  const CheckpointHead& head = job.from->head;
  job.settings = head.settings;
  job.settings.quiet = options.quiet;
  if (!options.vector.empty()) job.settings.request.vector = options.vector;
  if (options.threads) job.settings.request.threads = *options.threads;
  job.settings.resumed.push_back(head.step);
  job.checkpoint_every = options.checkpoint_every;
  const SceneFile file = load_scene(folder, options, head);
  check_memory(file, job.settings.request.kernel, available_memory());
  job.scene = file.scene();
  job.problem = load_problem(file, load_initial(folder, job.settings));
  if (state_hash(job.problem.initial) != head.start) {
    throw InputError(fmt::format("{}: the start of the run is not that of its checkpoint",
                                 (folder / "initial.csv").string()));
  }
  if (!options.quiet) {
    print_out("going on from step {}, t = {:.9g} s\n", head.step, head.time);
    flush_output();
  }
  if (options.end || options.steps) write_file_whole(folder / "scene.toml", to_toml(job.scene));
  try {
    return carry_out(job, directory);
  } catch (const WordsError& error) {
    throw InputError(fmt::format("{}: what it holds is not this run's: {}",
                                 (folder / checkpoint_name).string(), error.what()));
  }
}

}  // namespace

void add_resume_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("resume", "Go on with what was stopped, or with a run beyond its end");
  command->add_option("DIR", options->directory, "Where the command was to write (its --out)")
      ->required();
  auto* steps = command->add_option("--steps", options->steps, "Stop after N steps in all");
  command->add_option("--t-end", options->end, "Stop at time T, s [as the run was to]")
      ->excludes(steps);
  command->add_option("--vector", options->vector, "auto, avx2 or avx512 [as the run]");
  command->add_option("--threads", options->threads,
                      "1 to 256; 0: as the plan decides [as the run]");
  command->add_option("--checkpoint-every", options->checkpoint_every,
                      "Write the run down every N seconds; 0: never [60]");
  command->add_flag("--before", options->before, "From the checkpoint before the last one");
  command->add_flag("--force", options->force,
                    "Also with the checkpoint of another commit, whose bits may be others");
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but errors");
  command->footer(
      "A run writes itself down once a minute, when it is stopped (Ctrl-C, SIGTERM, SIGHUP) and at "
      "its\n"
      "end. Whatever ended it, it goes on from the last time and ends with the same bits, rows "
      "and\n"
      "frames as one that was never stopped, with any number of threads and any vectors.\n"
      "Of stability, accuracy, reference, extremes and verify, which keep the cases that they "
      "have\n"
      "done, the command is given again as it was; the options here are for runs.\n"
      "Exit code: as of that command.\n\n"
      "Examples:\n"
      "  bounce resume runs/example-2\n"
      "  bounce resume runs/example-2 --t-end 20\n");
  command->callback([options, &context] { context.exit_code = resume(*options); });
}

}  // namespace bounce
