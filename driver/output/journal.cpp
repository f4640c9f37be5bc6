#include "driver/output/journal.hpp"

#include <charconv>
#include <iterator>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/output/run_directory.hpp"
#include "driver/world/console.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/origin.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int format = 1;

fs::path path_of(const fs::path& output) { return plain_path(output) += ".journal"; }

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::uint64_t checksum(const std::string& key, const std::vector<std::uint64_t>& words) {
  Checksum sum;
  sum.add(key);
  sum.add(std::span(words));
  return sum.value();
}

std::string hex(const std::vector<std::uint64_t>& words) {
  std::string text;
  text.reserve(16 * words.size());
  for (const std::uint64_t word : words) fmt::format_to(std::back_inserter(text), "{:016x}", word);
  return text;
}

// Nothing if the text is no such words.
std::optional<std::vector<std::uint64_t>> words_of(const std::string& text) {
  if (text.size() % 16 != 0) return std::nullopt;
  std::vector<std::uint64_t> words(text.size() / 16);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const char* const end = text.data() + 16 * (i + 1);
    if (std::from_chars(end - 16, end, words[i], 16).ptr != end) return std::nullopt;
  }
  return words;
}

struct Case {
  std::string key;
  std::vector<std::uint64_t> words;
};
std::optional<Case> read_case(const std::string& line) {
  try {
    const Json json = Json::parse(line);
    const auto words = words_of(json.at(1).get<std::string>());
    Case found{json.at(0).get<std::string>(), words.value_or(std::vector<std::uint64_t>{})};
    if (!words || json.at(2).get<std::uint64_t>() != checksum(found.key, found.words)) {
      return std::nullopt;
    }
    return found;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

Journal::Journal(const fs::path& output, const Invocation& asked, const std::string& task,
                 bool replace) {
  if (output.empty()) return;
  path_ = path_of(output);
  const std::string head = dump({{"journal", format},
                                 {"arguments", asked.arguments},
                                 {"folder", asked.folder.string()},
                                 {"commit", find_origin().commit},
                                 {"task", Json::parse(task)}}) +
                           "\n";
  if (fs::exists(fs::symlink_status(path_))) read(head, replace);
  if (file_) return;
  fs::remove(path_);
  file_.emplace(path_);
  file_->write(head);
  file_->flush();
}

Journal::~Journal() {
  std::error_code ignored;
  if (file_ && size() == 0) fs::remove(path_, ignored);
}

// Opens what is there, if it is of this task, at the end of what can be believed.
void Journal::read(const std::string& head, bool replace) {
  const std::string text = read_bytes(path_.string());
  const std::size_t first = text.find('\n');
  if (first == std::string::npos) return;  // killed while it was begun
  try {
    const Json there = Json::parse(text.substr(0, first)), here = Json::parse(head);
    for (const char* key : {"journal", "commit", "task"}) {
      if (there.at(key) == here.at(key)) continue;
      if (replace) return;
      throw InputError(fmt::format(
          "{}: a command with other arguments, or of another build, was stopped there; --force "
          "drops it",
          path_.string()));
    }
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}: is there, and is no journal of bounce", path_.string()));
  }
  std::size_t from = first + 1;
  for (std::size_t end = text.find('\n', from); end != std::string::npos;
       end = text.find('\n', from)) {
    auto found = read_case(text.substr(from, end - from));
    if (!found) break;
    found_[found->key] = std::move(found->words);
    from = end + 1;
  }
  file_.emplace(path_, from);
}

void Journal::add_line(const std::string& key, const std::vector<std::uint64_t>& words) {
  if (!file_) return;
  const std::lock_guard lock(adding_);
  file_->write(dump({key, hex(words), checksum(key, words)}) + "\n");
  file_->flush();
  ++added_;
  const auto now = std::chrono::steady_clock::now();
  if (now - on_disk_ < std::chrono::seconds(1)) return;  // a disk takes its time
  file_->sync();
  on_disk_ = now;
}

void Journal::finish() {
  if (!file_) return;
  file_->close();
  file_.reset();
  fs::remove(path_);
}

void say_going_on(std::size_t done, std::size_t all) {
  if (done == 0) return;
  print_err("bounce: going on with a stopped command: {} of {} cases are there\n", done, all);
}

void say_stopped(std::size_t done, std::size_t all, const Journal& journal,
                 const fs::path& output) {
  if (journal.name().empty()) {
    print_err("bounce: interrupted after {} of {} cases; nothing was written\n", done, all);
    return;
  }
  print_err(
      "bounce: interrupted; {} of {} cases are kept; the same command, or \"bounce resume {}\", "
      "goes on with them\n",
      done, all, output.string());
}

std::optional<Invocation> find_journal(const fs::path& output) {
  const fs::path path = path_of(output);
  if (!fs::exists(path)) return std::nullopt;
  const std::string text = read_bytes(path.string());
  try {
    const Json head = Json::parse(text.substr(0, text.find('\n')));
    return Invocation{head.at("arguments").get<std::vector<std::string>>(),
                      head.at("folder").get<std::string>()};
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}: is no journal of bounce", path.string()));
  }
}

}  // namespace bounce
