#include "driver/world/child_process.hpp"

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "driver/world/interrupt.hpp"

namespace bounce {
namespace {

// Where the child's output goes, and where it stands.
class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  void stand_in(const std::filesystem::path& folder) {
    posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
  }
  void send(int stream, const std::string& file) {
    posix_spawn_file_actions_addopen(&actions_, stream, file.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0644);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

ProcessEnd run_this_program(const std::vector<std::string>& arguments,
                            const std::filesystem::path& folder, const std::string& out,
                            const std::string& err, double seconds) {
  static const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  FileActions actions;
  actions.stand_in(folder);
  actions.send(STDOUT_FILENO, out);
  actions.send(STDERR_FILENO, err);
  pid_t child = 0;
  const int error =
      posix_spawn(&child, program.c_str(), actions.get(), nullptr, argv.data(), environ);
  if (error != 0) throw std::runtime_error(program + ": cannot be run: " + std::strerror(error));
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  ProcessEnd result;
  bool asked_to_end = false;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (interrupted() && !asked_to_end) {
      asked_to_end = true;
      kill(child, SIGTERM);
    }
    if (!result.timed_out && std::chrono::steady_clock::now() > end) {
      result.timed_out = true;
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

}  // namespace bounce
