// The cases that a long command has done, so that it goes on with them when it is stopped and asked
// the same again.
//
// The file NAME.journal stands beside the output NAME while the command is at work: a line that
// says what was asked, then a line a case, added as soon as it is done,
//
//   {"journal":1,"arguments":["stability", ...],"folder":"/...","task":{...}}
//   ["leapfrog,flight,dt,16000","0000...",1234]          key, 64-bit words, checksum of both
//
// A line that is torn or damaged ends what is believed. With the last case done the file goes.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "driver/world/files.hpp"
#include "driver/world/invocation.hpp"
#include "verify/watch/words.hpp"

namespace bounce {

class Journal {
 public:
  /// Of the command that makes `output`; "": none is kept. `task`: JSON of all that a case's result
  /// depends on; the program's commit is added. Throws InputError if the cases of another task are
  /// there and may not be dropped (`replace`).
  Journal(const std::filesystem::path& output, const Invocation& asked, const std::string& task,
          bool replace);
  /// Leaves the file for the same command to go on with, if there is a case in it.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Cases there are, found and added.
  [[nodiscard]] std::size_t size() const { return found_.size() + added_; }
  /// The result of a case, if it is there; T has a serialize(), or is what words.hpp knows.
  template <class T>
  std::optional<T> find(const std::string& key) const {
    const auto at = found_.find(key);
    if (at == found_.end()) return std::nullopt;
    try {
      T value{};
      WordReader words(at->second);
      words(value);
      words.finish();
      return value;
    } catch (const WordsError&) {  // it is done once more
      return std::nullopt;
    }
  }
  /// Adds a case. Any thread may call it.
  template <class T>
  void add(const std::string& key, const T& value) {
    std::vector<std::uint64_t> all;
    WordWriter words([&all](std::span<const std::uint64_t> some) {
      all.insert(all.end(), some.begin(), some.end());
    });
    words(value);
    words.finish();
    add_line(key, all);
  }
  /// Where it is, "" if nowhere.
  [[nodiscard]] std::string name() const { return path_.string(); }
  /// The command has done all it was asked, or never can: removes the file.
  void finish();

 private:
  void read(const std::string& head, bool replace);
  void add_line(const std::string& key, const std::vector<std::uint64_t>& words);

  std::filesystem::path path_;
  std::map<std::string, std::vector<std::uint64_t>> found_;
  std::size_t added_ = 0;
  std::mutex adding_;
  std::optional<OutputFile> file_;
  std::chrono::steady_clock::time_point on_disk_ = std::chrono::steady_clock::now();
};

/// Says on stderr that a command goes on with `done` of `all` cases, if there are any.
void say_going_on(std::size_t done, std::size_t all);
/// Says on stderr that a command for `output` was stopped, and how it goes on.
void say_stopped(std::size_t done, std::size_t all, const Journal& journal,
                 const std::filesystem::path& output);

/// What was asked of the command whose journal stands beside `output`; nothing if there is none.
std::optional<Invocation> find_journal(const std::filesystem::path& output);

}  // namespace bounce
