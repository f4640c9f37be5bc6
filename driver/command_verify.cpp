// bounce verify: the kernels against the oracle, as a table.
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/equivalence_table.hpp"
#include "driver/output/journal.hpp"
#include "driver/output/run_directory.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/origin.hpp"
#include "driver/world/progress.hpp"
#include "kernels/stepping/threads.hpp"
#include "verify/oracle/equivalence.hpp"
#include "verify/oracle/oracle.hpp"
#include "verify/oracle/wall_scenes.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t default_steps = 1000000;
constexpr std::int64_t quick_steps = 50000;
constexpr std::int64_t wall_steps = 100000;  // of each scene once more, started at the wall

struct Interrupted {};

struct Options {
  std::vector<std::string> scenes;
  bool walls = false;  // the scenes of walls, too
  bool quick = false;
  bool full = false;
  std::string vector = "auto";
  std::string out;
};

// One scene to be run, and for how long.
struct Case {
  std::string name;
  Scene scene;
  std::int64_t steps = 0;
  bool observables = false;
  std::vector<EquivalenceRow> rows;
};

std::vector<Case> make_cases(const Options& options) {
  std::vector<Case> cases;
  std::vector<Scene> scenes;  // each read once: it may come from a pipe
  for (const std::string& name : options.scenes) scenes.push_back(SceneFile::find(name).scene());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const std::string& name = options.scenes[i];
    const Scene& scene = scenes[i];
    if (const std::string refusal = Oracle::refusal(scene); !refusal.empty()) {
      throw InputError(
          fmt::format("bounce verify {}: the oracle cannot run it: {}", name, refusal));
    }
    const std::int64_t whole = scene.steps_until(scene.time.end);
    const std::int64_t steps = options.full ? whole : options.quick ? quick_steps : default_steps;
    cases.push_back({name, scene, std::min(steps, whole), true, {}});
  }
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (scenes[i].walls.empty()) continue;
    const std::int64_t steps = options.quick ? quick_steps : wall_steps;
    cases.push_back({options.scenes[i] + " at the wall", at_the_wall(scenes[i]), steps, true, {}});
  }
  if (!options.walls) return cases;
  for (const WallScene& each : wall_scenes()) {
    cases.push_back({each.name, each.scene, wall_scene_steps, false, {}});
  }
  return cases;
}

// Cases on all cores, each on one; the longest first, so that none is left alone at the end. Those
// that the journal has are not run. False if interrupted.
bool run_cases(std::vector<Case>& cases, const std::vector<KernelUnderTest>& kernels,
               Journal& journal) {
  std::vector<Case*> order;
  std::int64_t total = 0;
  for (Case& each : cases) {
    if (auto rows = journal.find<std::vector<EquivalenceRow>>(each.name)) {
      each.rows = std::move(*rows);
      continue;
    }
    order.push_back(&each);
    total += each.steps;
  }
  say_going_on(cases.size() - order.size(), cases.size());
  std::stable_sort(order.begin(), order.end(),
                   [](const Case* a, const Case* b) { return a->steps > b->steps; });
  std::vector<std::atomic<std::int64_t>> done(order.size());
  Progress progress(isatty(STDERR_FILENO) != 0, total, 1e-6);
  std::atomic<std::size_t> ended{cases.size() - order.size()};
  parallel_for(order.size(), 0, [&](std::size_t i) {
    Case& each = *order[i];
    const auto report = [&](std::int64_t steps) {
      if (interrupted()) throw Interrupted{};
      done[i].store(steps);
      if (omp_get_thread_num() != 0) return;
      std::int64_t sum = 0;
      for (const auto& part : done) sum += part.load();
      progress.update(sum);
    };
    try {
      report(0);
      each.rows =
          check_equivalence(each.name, each.scene, each.steps, each.observables, kernels, report);
      journal.add(each.name, each.rows);
      ++ended;
    } catch (const Interrupted&) {  // of all that are left
    }
  });
  return ended == cases.size();
}

// The rows of all cases, in the order of the cases.
std::vector<EquivalenceRow> rows_of(const std::vector<Case>& cases) {
  std::vector<EquivalenceRow> rows;
  for (const Case& each : cases) rows.insert(rows.end(), each.rows.begin(), each.rows.end());
  return rows;
}

constexpr const char* explanation =
    "strict: the oracle's bits at every step. The others: velocities within the rounding of one "
    "kick,\n"
    "positions within one last place at the first differing step; from then on at most ten times "
    "as far "
    "off\n"
    "as a ball that was disturbed by one ULP at its start (six such balls run along). Differences "
    "are\n"
    "the largest so far; observables are compared every 10 000 steps.\n";

// What the rows of a case depend on, beside its name.
std::string task_of(const std::vector<Case>& cases, const Options& options) {
  nlohmann::ordered_json json{{"vector", options.vector},
                              {"cases", nlohmann::ordered_json::array()}};
  for (const Case& each : cases) {
    json["cases"].push_back({each.name, to_toml(each.scene), each.steps});
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

int verify(const Options& options, const CommandContext& context) {
  if (!options.out.empty()) check_output_path(options.out, true);
  std::vector<Case> cases = make_cases(options);
  catch_interrupts();
  std::error_code ignored;  // a device has no journal
  const bool keeps = !options.out.empty() && (!fs::exists(options.out, ignored) ||
                                              fs::is_regular_file(options.out, ignored));
  const std::optional<OutputLock> lock =
      keeps ? std::optional<OutputLock>(std::in_place, plain_path(options.out), options.out)
            : std::nullopt;
  Journal journal(keeps ? options.out : "", context.asked, task_of(cases, options), true);
  if (!run_cases(cases, kernels_under_test(options.vector), journal)) {
    const auto done = std::count_if(cases.begin(), cases.end(),
                                    [](const Case& each) { return !each.rows.empty(); });
    say_stopped(static_cast<std::size_t>(done), cases.size(), journal, options.out);
    return interrupt_exit_code();
  }
  const std::vector<EquivalenceRow> rows = rows_of(cases);
  const Origin origin = find_origin();
  const std::string text =
      fmt::format("{}\n{}\n{}\ncommit {}, {} {}, {}, {}\n", equivalence_table(rows), explanation,
                  equivalence_verdict(rows), origin.commit, origin.compiler, origin.flags,
                  origin.cpu, origin.date);
  print_out("{}", text);
  if (!options.out.empty()) write_file_whole(options.out, text);
  journal.finish();
  return is_equivalent(rows) ? 0 : 1;
}

}  // namespace

void add_verify_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "verify", "Check the kernels against the oracle (exit 1 if one fails)");
  command->add_option("SCENES", options->scenes, "Scenes to run (default: example-1 to example-7)");
  auto* quick = command->add_flag("--quick", options->quick, "50 000 steps of each scene");
  command->add_flag("--full", options->full, "The scenes' full length (default: 1 million steps)")
      ->excludes(quick);
  command->add_option("--vector", options->vector, "auto, avx2 or avx512");
  command->add_option("--out", options->out, "Write the table to this file, too");
  command->footer(
      "Each scene with walls is also run for a short while from just above its wall, at the\n"
      "speed of its impact, so that short checks reach the contact. Where no scene is named,\n"
      "those of other walls come on top: ceilings, slopes, two walls, starts on a wall and\n"
      "behind it.\n"
      "Examples:\n"
      "  bounce verify --quick\n"
      "  bounce verify example-2 example-5\n"
      "  bounce verify --full --out equivalence.txt    (about an hour on two cores)\n");
  command->callback([options, &context] {
    options->walls = options->scenes.empty();
    if (options->scenes.empty()) {
      for (int i = 1; i <= 7; ++i) options->scenes.push_back("example-" + std::to_string(i));
    }
    context.exit_code = verify(*options, context);
  });
}

}  // namespace bounce
