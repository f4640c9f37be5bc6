// The program itself, run as a user runs it, in a folder of its own. BOUNCE_PROGRAM is its path.
#pragma once

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "verify/tests/driver/file_contents.hpp"

namespace bounce {

using Words = std::vector<std::string>;

inline std::ptrdiff_t lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

inline int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// The number after the first `word` of a text; NaN if there is none.
inline double number_after(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  if (at == std::string::npos) return std::nan("");
  char* end = nullptr;
  const char* from = text.c_str() + at + word.size();
  const double value = std::strtod(from, &end);
  return end == from ? std::nan("") : value;
}

/// The text of a top-level entry of a JSON file as bounce writes it, quotes and all; "": none.
inline std::string entry(const fs::path& json, const std::string& key) {
  const std::string text = contents(json);
  const std::string start = "\n  \"" + key + "\": ";
  const auto at = text.find(start);
  if (at == std::string::npos) return "";
  const auto from = at + start.size();
  return text.substr(from, text.find_first_of(",\n", from) - from);
}

class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Starts the program in the test's folder, its output in the files stdout and stderr.
  pid_t start(Words words) {
    words.insert(words.begin(), BOUNCE_PROGRAM);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      const int flags = O_WRONLY | O_CREAT | O_TRUNC;
      if (chdir(folder_.c_str()) != 0) _exit(99);
      if (largest_file_ > 0) {
        const rlimit limit{largest_file_, largest_file_};
        signal(SIGXFSZ, SIG_IGN);  // so that writing fails, as on a full disk
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
      }
      if (memory_ > 0) {
        const rlimit limit{memory_, memory_};
        if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(99);
      }
      // However the test itself was started.
      for (const int usual : {SIGINT, SIGHUP, SIGTERM}) signal(usual, SIG_DFL);
      for (const int ignored : ignored_) signal(ignored, SIG_IGN);
      dup2(stdout_ >= 0 ? stdout_ : open("stdout", flags, 0600), STDOUT_FILENO);
      dup2(open("stderr", flags, 0600), STDERR_FILENO);
      execv(BOUNCE_PROGRAM, arguments.data());
      _exit(99);
    }
    // kill(-1) would end all that this user runs.
    if (child < 0) throw std::runtime_error("no process could be started");
    return child;
  }
  // The exit code; 1000 + signal if it was killed, by us if it takes ten minutes.
  static int finish(pid_t child) {
    int status = 0;
    for (int wait = 0; waitpid(child, &status, WNOHANG) == 0; ++wait) {
      if (wait == 120000) kill(child, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  int run(const Words& words) { return finish(start(words)); }
  // A script for /bin/sh in the test's folder, in which $BOUNCE is the program; 124 after two
  // minutes.
  int shell(const std::string& script) {
    const std::string text = "exec > stdout 2> stderr\nBOUNCE='" BOUNCE_PROGRAM "'\ncd '" +
                             folder_.string() + "'\n" + script + "\n";
    const std::string command = "cd '" + folder_.string() + "' && timeout 120 /bin/sh script";
    std::ofstream(folder_ / "script") << text;
    const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
    fs::remove(folder_ / "script");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  // Waits, at most 20 s, until there is something of that name in the folder.
  void wait_for(const std::string& name) const {
    for (int wait = 0; wait < 4000; ++wait) {
      if (fs::exists(folder_ / name)) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ADD_FAILURE() << "no " << name;
  }

  [[nodiscard]] std::string out() const { return contents(folder_ / "stdout"); }
  [[nodiscard]] std::string err() const { return contents(folder_ / "stderr"); }
  // Names in a folder, sorted, without the captured output.
  [[nodiscard]] Words names(const fs::path& below = ".") const {
    Words found;
    for (const auto& item : fs::directory_iterator(folder_ / below)) {
      const std::string name = item.path().filename();
      if (name != "stdout" && name != "stderr") found.push_back(name);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  fs::path folder_;
  rlim_t largest_file_ = 0;   // bytes the program may write to a file; 0: no limit
  rlim_t memory_ = 0;         // bytes it may take; 0: no limit
  int stdout_ = -1;           // where its output goes instead of the file stdout
  std::vector<int> ignored_;  // signals that it is started with as ignored
};

}  // namespace bounce
