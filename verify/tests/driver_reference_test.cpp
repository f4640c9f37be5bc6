// bounce reference as a user runs it. BOUNCE_PROGRAM is the program's path.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

class DriverReferenceTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  // The exit code; 1000 + signal if it was killed.
  int run(Words words) {
    words.insert(words.begin(), {BOUNCE_PROGRAM, "reference"});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      const int flags = O_WRONLY | O_CREAT | O_TRUNC;
      if (chdir(folder_.c_str()) != 0) _exit(99);
      dup2(open("stdout", flags, 0600), STDOUT_FILENO);
      dup2(open("stderr", flags, 0600), STDERR_FILENO);
      execv(BOUNCE_PROGRAM, arguments.data());
      _exit(99);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  [[nodiscard]] std::string out() const { return contents(folder_ / "stdout"); }
  [[nodiscard]] std::string err() const { return contents(folder_ / "stderr"); }
  // Nothing but what the shell made.
  [[nodiscard]] bool left_nothing() const {
    return std::all_of(fs::directory_iterator(folder_), fs::directory_iterator{},
                       [](const fs::directory_entry& entry) {
                         const std::string name = entry.path().filename().string();
                         return name == "stdout" || name == "stderr" ||
                                (name == "runs" && fs::is_empty(entry.path()));
                       });
  }
  // Just above the axis at the speed of its impact.
  static Words landing(Words more) {
    Words words{"example-1", "--set", "ball.centre=[0,7.01]", "--set", "ball.velocity=[0,-0.767]"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  fs::path folder_;
};

TEST_F(DriverReferenceTest, WritesItsDirectoryWhole) {
  ASSERT_EQ(run(landing({"--t-end", "0.045"})), 0) << err();
  const fs::path made = folder_ / "runs/example-1-reference";
  const auto json = nlohmann::json::parse(contents(made / "observables.json"));
  // 0, 0.01 ... 0.04, and the end.
  EXPECT_EQ(lines(contents(made / "reference.csv")), 1 + 6);
  EXPECT_EQ(lines(contents(made / "final.csv")), 1 + 360);
  EXPECT_EQ(lines(contents(made / "before-impact.csv")), 1 + 360);
  const auto contacts = json["fixed"]["contacts"].get<int>();
  EXPECT_GE(contacts, 3);
  EXPECT_EQ(lines(contents(made / "contacts.csv")),
            1 + contacts + json["adaptive"]["contacts"].get<int>());
  EXPECT_TRUE(fs::exists(made / "scene.toml"));
  EXPECT_EQ(json["before_impact"]["t"], 0.01);
  EXPECT_LE(json["before_impact"]["position_error"].get<double>(), 1e-11);
  EXPECT_NEAR(json["observables"]["end_height"]["value"].get<double>(), 7.01 - 0.045 * 0.767, 1e-3);
  const double error = json["observables"]["end_height"]["error"].get<double>();
  EXPECT_GT(error, 0.0);
  EXPECT_LE(error, 1e-11);
  EXPECT_GT(json["growth"]["factor"].get<double>(), 0.0);
  EXPECT_FALSE(json["origin"]["commit"].get<std::string>().empty());
  EXPECT_NE(out().find("end_height"), std::string::npos);

  EXPECT_EQ(run(landing({"--t-end", "0.02"})), 2);
  EXPECT_NE(err().find("--force"), std::string::npos) << err();
  EXPECT_EQ(run(landing({"--t-end", "0.02", "--force"})), 0) << err();
  EXPECT_EQ(lines(contents(made / "reference.csv")), 1 + 3);
}

TEST_F(DriverReferenceTest, RefusesWithOneMessageAndLeavesNothing) {
  const auto refused = [&](const Words& words, const std::string& why) {
    EXPECT_EQ(run(words), 2) << words.back();
    EXPECT_EQ(lines(err()), 1) << err();
    EXPECT_NE(err().find(why), std::string::npos) << err();
    EXPECT_TRUE(left_nothing());
  };
  refused({"example-1", "--tolerance", "nan"}, "--tolerance");
  refused({"example-1", "--tolerance", "1"}, "--tolerance");
  refused({"example-1", "--step", "-1"}, "--step");
  refused({"example-1", "--every", "0"}, "--every");
  refused({"example-1", "--every", "1e-6"}, "GB");
  refused({"example-1", "--disturbed", "0"}, "--disturbed");
  refused({"example-1", "--set", "ball.centre=[0,6.99995]", "--set", "ball.rounding=none"},
          "behind wall[0]");
  refused({"nowhere"}, "nowhere");
}

}  // namespace
