// What a run takes in memory, against what is said of it beforehand. BOUNCE_PROGRAM is the
// program's path.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "driver/scene/memory_check.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/limits.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> settings{"ball.per_ring=200000", "ball.rounding=none",
                                        "ball.radii=[1000, 1001, 1002]", "ball.centre=[0, 1010]",
                                        "law.elasticity=1e-3"};

SceneFile large_ball() {
  SceneFile file = SceneFile::find("large-ball");
  for (const std::string& setting : settings) file.set(setting);
  return file;
}

// Peak bytes of `bounce run` on this ball; 0 if it failed.
double peak_of_run(const fs::path& folder, const std::string& kernel,
                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{BOUNCE_PROGRAM, "run",   "large-ball",
                                 "--steps",      "4",     "--kernel",
                                 kernel,         "--out", (folder / kernel).string()};
  std::vector<std::string> all = settings;
  all.insert(all.end(), more.begin(), more.end());
  for (const std::string& setting : all) {
    words.emplace_back("--set");
    words.push_back(setting);
  }
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    execv(BOUNCE_PROGRAM, arguments.data());
    _exit(99);
  }
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child || status != 0) return 0.0;
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

TEST(MemoryCheck, ARunTakesNoMoreThanItSays) {
  std::string name = (fs::temp_directory_path() / "bounce-test-XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  for (const char* kernel : {"ring", "csr"}) {
    const double peak = peak_of_run(name, kernel);
    EXPECT_GT(peak, 600000 * 64.0) << kernel;
    EXPECT_LE(peak, run_bytes(large_ball().scene(), kernel)) << kernel;
    // It must not refuse what fits easily, either.
    EXPECT_LE(run_bytes(large_ball().scene(), kernel), 2.0 * peak) << kernel;
  }
  fs::remove_all(name);
}

// On the floor, so that it walks beside the ball that flies.
TEST(MemoryCheck, SoDoesOneWithLocatedContact) {
  std::string name = (fs::temp_directory_path() / "bounce-test-XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  const std::vector<std::string> more{"wall.contact=located", "ball.centre=[0, 1002.0000001]",
                                      "ball.velocity=[0, -1]"};
  SceneFile file = large_ball();
  for (const std::string& setting : more) file.set(setting);
  const double peak = peak_of_run(name, "ring", more), said = run_bytes(file.scene(), "ring");
  const double plain = peak_of_run(fs::path(name) / "plain", "ring");
  EXPECT_GT(plain, 0.0);
  EXPECT_GT(peak, 1.2 * plain);
  EXPECT_LE(peak, said);
  EXPECT_LE(said, 2.0 * peak);
  fs::remove_all(name);
}

TEST(MemoryCheck, RefusesNamingKeyValueAndWhatIsAllowed) {
  const SceneFile file = large_ball();
  const double needed = run_bytes(file.scene(), "auto");
  EXPECT_NO_THROW(check_memory(file, "auto", needed));
  EXPECT_NO_THROW(check_memory(file, "auto", available_memory()));
  try {
    check_memory(file, "auto", 0.5 * needed);
    FAIL() << "it was let through";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("--set: ball.per_ring = 200000: allowed is a ball of at most "),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("this one has 6e+05"), std::string::npos) << text;
  }
  EXPECT_THROW(check_memory(file, "auto", 0.0), InputError);
  SceneFile disc = SceneFile::find("disc");
  disc.set("ball.spacing=0.01");
  EXPECT_NO_THROW(check_memory(disc, "auto", 1e9));
  disc.set("ball.spacing=0.003");
  EXPECT_THROW(check_memory(disc, "auto", 1e9), InputError);
}

// In a process of its own: the limit stays.
TEST(MemoryCheck, KnowsALimitOfTheProcess) {
  constexpr rlim_t more = rlim_t{64} << 20;
  EXPECT_GT(available_memory(), static_cast<double>(more));
  const pid_t child = fork();
  if (child == 0) {
    std::ifstream status("/proc/self/statm");
    rlim_t pages = 0;
    status >> pages;
    const rlim_t now = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    const rlimit limit{now + more, now + more};
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(1);
    _exit(available_memory() <= static_cast<double>(more) ? 0 : 2);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace bounce
