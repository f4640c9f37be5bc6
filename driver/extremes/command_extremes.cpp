// bounce extremes: scenes at the edge of what a program can bear, each with what it should do.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "driver/extremes/extreme_table.hpp"
#include "driver/output/journal.hpp"
#include "driver/output/run_directory.hpp"
#include "driver/world/commands.hpp"
#include "driver/world/console.hpp"
#include "driver/world/files.hpp"
#include "driver/world/interrupt.hpp"
#include "driver/world/near_miss.hpp"
#include "kernels/stepping/threads.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> only;
  std::string out;
  std::string runs;
  int threads = 0;
  bool quick = false;
  bool list = false;
};

// All rows built in, and those that --only names as files.
std::vector<ExtremeRow> all_rows(Options& options) {
  std::vector<ExtremeRow> rows = extreme_rows();
  for (std::string& name : options.only) {
    if (!name.ends_with(".toml")) continue;
    rows.push_back(read_extreme_row(fs::path(name).stem(), read_text_file(name)));
    name = rows.back().name;
  }
  return rows;
}

// The rows to run. One that is like another brings that one along.
std::vector<ExtremeEntry> chosen(Options options) {
  std::vector<ExtremeRow> rows = all_rows(options);
  std::vector<std::string> names;
  names.reserve(rows.size());
  for (const ExtremeRow& row : rows) names.push_back(row.name);
  for (const std::string& name : options.only) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw InputError(fmt::format("--only {}: no such row{} (allowed are: {})", name,
                                   did_you_mean(name, names), fmt::join(names, ", ")));
    }
  }
  std::vector<std::string> wanted = options.only;
  for (const ExtremeRow& row : rows) {
    const bool asked = options.only.empty()
                           ? row.quick || !options.quick
                           : std::find(wanted.begin(), wanted.end(), row.name) != wanted.end();
    if (asked) wanted.insert(wanted.end(), {row.name, row.like});
  }
  std::vector<ExtremeEntry> entries;
  for (ExtremeRow& row : rows) {
    if (std::find(wanted.begin(), wanted.end(), row.name) == wanted.end()) continue;
    entries.push_back({std::move(row), {}});
  }
  return entries;
}

// Where the runs' files are: a directory of the user's, or one that goes away again.
class RunsFolder {
 public:
  explicit RunsFolder(const std::string& wanted) : keep_(!wanted.empty()) {
    if (keep_) {
      std::error_code error;
      if (!fs::create_directory(wanted, error)) {
        throw InputError(fmt::format("--runs {}: a directory cannot be made there: {}", wanted,
                                     error ? error.message() : std::string("it exists already")));
      }
      path_ = fs::absolute(wanted);
      return;
    }
    std::string name = (fs::temp_directory_path() / "bounce-extremes-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error(name + ": a directory cannot be made there");
    }
    path_ = name;
  }
  ~RunsFolder() {
    std::error_code ignored;
    if (!keep_) fs::remove_all(path_, ignored);
  }
  RunsFolder(const RunsFolder&) = delete;
  RunsFolder& operator=(const RunsFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  bool keep_;
  fs::path path_;
};

// Where the tables go, made sure of before the rows run; "" if they go nowhere.
class TableFolder {
 public:
  explicit TableFolder(const std::string& wanted) : path_(wanted) {
    if (wanted.empty()) return;
    try {
      folders_.make(plain_path(wanted));
    } catch (const std::system_error& error) {
      throw InputError(fmt::format("--out {}: a directory cannot be made there: {}", wanted,
                                   error.code().message()));
    }
    lock_.emplace(plain_path(wanted), wanted);
    for (const fs::path& file : {csv(), markdown()}) check_output_path(file, true);
  }
  [[nodiscard]] fs::path csv() const { return path_ / "extremes.csv"; }
  [[nodiscard]] fs::path markdown() const { return path_ / "extremes.md"; }

 private:
  fs::path path_;
  MadeFolders folders_;
  std::optional<OutputLock> lock_;
};

double steps_of(const ExtremeRow& row) { return row.scene.time.end / row.scene.time.step; }

// Whether the row is like another one, or another one like it.
bool is_compared(const ExtremeRow& row, const std::vector<ExtremeEntry>& entries) {
  return !row.like.empty() ||
         std::any_of(entries.begin(), entries.end(),
                     [&row](const ExtremeEntry& other) { return other.row.like == row.name; });
}

// Rows side by side, the longest first; a line is printed as each ends. Those that the journal has
// are not run. How many there are in the end.
std::size_t run_rows(std::vector<ExtremeEntry>& entries, int threads, const fs::path& folder,
                     Journal& journal) {
  std::vector<ExtremeEntry*> order;
  for (ExtremeEntry& entry : entries) {
    if (auto result = journal.find<ExtremeResult>(entry.row.name)) {
      entry.result = std::move(*result);
    } else {
      order.push_back(&entry);
    }
  }
  std::size_t done = entries.size() - order.size();
  say_going_on(done, entries.size());
  std::stable_sort(order.begin(), order.end(), [](const ExtremeEntry* a, const ExtremeEntry* b) {
    return steps_of(a->row) > steps_of(b->row);
  });
  std::mutex one_at_a_time;
  parallel_for(order.size(), threads, [&](std::size_t i) {
    if (interrupted()) return;
    ExtremeEntry& entry = *order[i];
    entry.result = run_extreme_row(entry.row, folder, is_compared(entry.row, entries));
    const std::lock_guard lock(one_at_a_time);
    if (interrupted()) return;  // it may have been, too
    journal.add(entry.row.name, entry.result);
    ++done;
    print_err("{}\n", line_of(entry));
  });
  return done;
}

void compare_rows(std::vector<ExtremeEntry>& entries) {
  const std::string complete = name_of(Outcome::complete);
  for (ExtremeEntry& entry : entries) {
    if (entry.row.like.empty() || entry.result.happened != complete) continue;
    const auto like = std::find_if(entries.begin(), entries.end(), [&](const ExtremeEntry& other) {
      return other.row.name == entry.row.like;
    });
    if (like == entries.end() || like->result.happened != complete) {
      entry.result.as_expected = false;
      entry.result.detail += "; NOTHING TO COMPARE WITH: " + entry.row.like;
      continue;
    }
    compare_with_like(entry.row, like->row, like->result.last, entry.result);
  }
}

std::string task_of(const std::vector<ExtremeEntry>& entries) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ExtremeEntry& entry : entries) json.push_back({entry.row.name, entry.row.text});
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

int extremes(const Options& options, const CommandContext& context) {
  std::vector<ExtremeEntry> entries = chosen(options);
  if (options.list) {
    for (const auto& [row, result] : entries) {
      print_out("{:<24} {:<9} {}\n", row.name, name_of(row.expected), printable(row.scene.title));
    }
    return 0;
  }
  if (options.threads < 0 || options.threads > 256) {
    throw InputError(fmt::format("--threads {}: allowed is 0 to 256", options.threads));
  }
  const TableFolder tables(options.out);
  catch_interrupts();
  const RunsFolder folder(options.runs);
  Journal journal(options.out, context.asked, task_of(entries), true);
  const std::size_t done = run_rows(entries, options.threads, folder.path(), journal);
  if (done < entries.size()) {
    say_stopped(done, entries.size(), journal, options.out);
    return interrupt_exit_code();
  }
  compare_rows(entries);
  for (const ExtremeEntry& entry : entries) print_out("{}\n", line_of(entry));
  if (!options.out.empty()) {
    write_file_whole(tables.csv(), extremes_csv(entries));
    write_file_whole(tables.markdown(), extremes_markdown(entries, context.command_line));
  }
  journal.finish();
  const auto failed = std::count_if(entries.begin(), entries.end(), [](const ExtremeEntry& entry) {
    return !entry.result.as_expected;
  });
  print_out("{} of {} rows as expected\n", static_cast<std::ptrdiff_t>(entries.size()) - failed,
            entries.size());
  return failed == 0 ? 0 : 1;
}

}  // namespace

void add_extremes_command(CLI::App& program, CommandContext& context) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "extremes", "Run stiff and extreme scenes, each with what it should do");
  command
      ->add_option("--only", options->only,
                   "Run this row alone, or that of a file NAME.toml; may be given several times")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->add_option("-o,--out", options->out, "Write extremes.csv and extremes.md into DIR");
  command->add_option("--runs", options->runs, "Keep the runs' files in DIR, which must not exist");
  command->add_option("--threads", options->threads, "Rows run side by side; 0: one a core [0]");
  command->add_flag("--quick", options->quick, "The short rows alone");
  command->add_flag("--list", options->list, "Say which rows there are, and run none");
  command->footer(
      "Each row is a scene of driver/scenes/extremes/ (bounce show extremes/NAME). It either\n"
      "completes with its ledgers closed, or is refused before it starts, or stops with exit code "
      "3,\n"
      "its trouble named and its last good state kept; its file says which, and why.\n"
      "Exit code: 0 every row does what is expected, 1 one does not, 2 bad input, 130, 143 or 129\n"
      "stopped with Ctrl-C, SIGTERM or SIGHUP.\n\n"
      "Examples:\n"
      "  bounce extremes --quick\n"
      "  bounce extremes --only bond-1e-3 --runs runs/extremes\n"
      "  bounce run extremes/edge-above --force\n");
  command->callback([options, &context] { context.exit_code = extremes(*options, context); });
}

}  // namespace bounce
