// Runs that are killed, stopped, out of disk or taken beyond their end, and gone on with: nothing
// twice, nothing missing, the same bits.
#include <sys/mount.h>

#include <random>

#include "driver/world/origin.hpp"
#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

// A ball that comes to the floor at once, with frames and rows that are not in step.
const Words to_the_floor{
    "--set", "ball.centre=[0, 7.02]",     "--set", "ball.velocity=[0, -1]",
    "--set", "output.frames_every=0.013", "--set", "output.monitor_every=0.003"};

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class DriverResumeTest : public ProgramTest {
 protected:
  // Every file of two finished runs but run.json and the checkpoint, byte for byte.
  void expect_same_files(const std::string& a, const std::string& b) {
    EXPECT_EQ(names(a), names(b));
    for (const std::string& name : names(a)) {
      if (name == "run.json" || name == "checkpoint") continue;
      const std::string one = contents(folder_ / a / name), other = contents(folder_ / b / name);
      EXPECT_TRUE(one == other) << b << "/" << name
                                << " is not that of the run that was not stopped, " << a << "; "
                                << where_they_differ(one, other);
    }
    for (const char* key : {"status", "steps", "state_hash"}) {
      EXPECT_EQ(entry(folder_ / a / "run.json", key), entry(folder_ / b / "run.json", key)) << key;
    }
    EXPECT_EQ(section(a, "bounce"), section(b, "bounce"));
    EXPECT_EQ(section(a, "ledger"), section(b, "ledger"));
    EXPECT_EQ(section(a, "stability"), section(b, "stability"));
  }
  [[nodiscard]] std::string section(const std::string& run, const std::string& key) const {
    const std::string json = contents(folder_ / run / "run.json");
    const auto at = json.find("\n  \"" + key + "\": {");
    return at == std::string::npos ? "" : json.substr(at, json.find("\n  }", at) - at);
  }
  // The step of the checkpoint of a stopped run; -1: it has none.
  [[nodiscard]] double step_of(const std::string& run) const {
    const fs::path file = folder_ / (run + ".part") / "checkpoint";
    return fs::exists(file) ? number_after(contents(file), "\"step\":") : -1.0;
  }
  // Starts and goes on with a run until it is complete, killing it again and again; how often.
  int run_with_kills(const Words& words, const std::string& out, std::mt19937& random);
};

int DriverResumeTest::run_with_kills(const Words& words, const std::string& out,
                                     std::mt19937& random) {
  int kills = 0;
  double patience = 0.06;  // s; more where the machine is busy, and a run gets nowhere
  for (double before = -1.0; kills < 200;) {
    const bool stopped = step_of(out) >= 0.0;
    const pid_t child = start(stopped ? Words{"resume", out, "-q", "--checkpoint-every", "0.01"}
                                      : Words{"run"} + words + Words{"--out", out});
    const double seconds = patience * static_cast<double>(random() % 1000) / 1000.0;
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    kill(child, SIGKILL);
    const int code = finish(child);
    if (code != 1000 + SIGKILL) {
      EXPECT_EQ(code, 0) << err();
      break;
    }
    ++kills;
    const double now = step_of(out);
    if (now <= before) patience *= 1.3;
    before = now;
  }
  return kills;
}

TEST_F(DriverResumeTest, RunsThatAreKilledAgainAndAgainLoseNothing) {
  const Words example{"example-2", "-q", "--checkpoint-every", "0.01"};
  const std::vector<Words> runs{{"--kernel", "mirror", "--t-end", "1.2"},
                                {"--kernel", "ring", "--t-end", "0.8", "--listing-frames"},
                                {"--kernel", "csr", "--t-end", "0.3"},
                                {"--kernel", "ring", "--t-end", "0.05", "--ledger"},
                                {"--kernel", "mirror", "--set", "time.method=leapfrog", "--set",
                                 "wall.contact=resolved", "--t-end", "0.9"},
                                {"--set", "time.method=pefrl", "--set", "wall.contact=located",
                                 "--set", "time.step=1e-5", "--t-end", "0.3"}};
  std::mt19937 random(1);
  int kills = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::string whole = "whole" + std::to_string(i), cut = "cut" + std::to_string(i);
    const Words words = example + to_the_floor + runs[i];
    ASSERT_EQ(run(Words{"run"} + words + Words{"--out", whole}), 0) << err();
    for (int again = 0; again < 8 && kills < 9 * static_cast<int>(i + 1); ++again) {
      fs::remove_all(folder_ / cut);
      kills += run_with_kills(words, cut, random);
      expect_same_files(whole, cut);
    }
  }
  EXPECT_GE(kills, 50);
}

TEST_F(DriverResumeTest, ARunThatWasStoppedGoesOnWithOtherThreadsAndVectors) {
  const Words words = Words{"example-5", "-q", "--kernel", "ring", "--t-end", "1.5"} + to_the_floor;
  ASSERT_EQ(run(Words{"run"} + words + Words{"--out", "whole"}), 0) << err();
  const pid_t child = start(Words{"run"} + words + Words{"--out", "cut", "--threads", "2"});
  wait_for("cut.part/checkpoint");
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  kill(child, SIGTERM);
  EXPECT_EQ(finish(child), 128 + SIGTERM) << err();
  EXPECT_NE(err().find("go on from there with: bounce resume cut"), std::string::npos) << err();
  EXPECT_EQ(entry(folder_ / "cut/run.json", "status"), "\"interrupted\"");
  EXPECT_EQ(run({"resume", "cut/", "-q", "--threads", "1", "--vector", "avx2"}), 0) << err();
  expect_same_files("whole", "cut");
  EXPECT_NE(contents(folder_ / "cut/run.json").find("\"vector\": \"avx2\""), std::string::npos);
}

TEST_F(DriverResumeTest, ACompleteRunGoesOnBeyondItsEnd) {
  for (const char* contact : {"listing", "located"}) {
    const Words words = Words{"run",
                              "example-2",
                              "-q",
                              "--set",
                              "time.method=blanes-moan-6",
                              "--set",
                              "time.step=1e-4",
                              "--set",
                              std::string("wall.contact=") + contact} +
                        to_the_floor;
    const std::string whole = std::string("whole-") + contact, cut = std::string("cut-") + contact;
    ASSERT_EQ(run(words + Words{"--t-end", "0.6", "--out", whole}), 0) << err();
    // An end between two rows, so that it has one of its own, which the longer run has not.
    ASSERT_EQ(run(words + Words{"--t-end", "0.2501", "--out", cut}), 0) << err();
    ASSERT_EQ(run({"resume", cut, "-q", "--t-end", "0.6"}), 0) << err();
    expect_same_files(whole, cut);
  }
  EXPECT_EQ(run({"resume", "cut-listing", "-q", "--t-end", "0.1"}), 2);
  EXPECT_NE(err().find("allowed is an end from t = 0.6 s"), std::string::npos) << err();
}

// From a file that a run wrote, too: with a method that ends a step with a kick, or with a drift.
TEST_F(DriverResumeTest, AStateThatWasWrittenGoesOnToTheBit) {
  for (const char* kernel : {"mirror", "ring", "csr", "annulus"}) {
    for (const char* method : {"listing", "leapfrog", "pefrl"}) {
      const Words words = Words{"run",
                                "example-1",
                                "--kernel",
                                kernel,
                                "-q",
                                "--set",
                                "time.step=1e-4",
                                "--set",
                                std::string("time.method=") + method} +
                          to_the_floor;
      const std::string name = std::string(kernel) + "-" + method;
      ASSERT_EQ(run(words + Words{"--steps", "600", "--out", name + "-0"}), 0) << err();
      ASSERT_EQ(run(words + Words{"--steps", "200", "--out", name + "-1"}), 0) << err();
      ASSERT_EQ(run(words + Words{"--steps", "400", "--initial", name + "-1/final.csv", "--out",
                                  name + "-2"}),
                0)
          << err();
      EXPECT_EQ(err(), "");
      EXPECT_EQ(contents(folder_ / (name + "-0/final.csv")),
                contents(folder_ / (name + "-2/final.csv")))
          << name;
    }
  }
}

// What a file cannot hold is said.
TEST_F(DriverResumeTest, AStateOfAnotherRunSaysThatItDoesNotGoOnToTheBit) {
  const Words words{"run", "example-1", "--set", "time.step=1e-4", "--steps", "50"};
  const Words leapfrog{"--set", "time.method=leapfrog"};
  ASSERT_EQ(run(words + leapfrog + Words{"--out", "a"}), 0) << err();
  const std::string first = contents(folder_ / "a/final.csv");
  EXPECT_EQ(first.substr(0, first.find('\n')), "i,x,y,vx,vy,held_x,held_y,held_vx,held_vy");
  const Words from{"--initial", "a/final.csv"};
  ASSERT_EQ(run(words + leapfrog + from + Words{"--out", "b", "--set", "time.step=2e-4"}), 0);
  EXPECT_NE(err().find("does not go on to the bit; \"bounce resume DIR --t-end T\" does"),
            std::string::npos)
      << err();
  ASSERT_EQ(run(words + from + Words{"--out", "c", "--set", "wall.contact=located"}), 0);
  EXPECT_NE(err().find("not to the bit, as located contact knows more"), std::string::npos)
      << err();
}

TEST_F(DriverResumeTest, AFileThatMayNotGrowEndsARunThatCanGoOn) {
  const Words words =
      Words{"run", "example-2", "-q", "--t-end", "1.5", "--checkpoint-every", "0.01"} +
      to_the_floor;
  ASSERT_EQ(run(words + Words{"--out", "whole"}), 0) << err();
  largest_file_ = fs::file_size(folder_ / "whole/frames.extxyz") / 2;
  EXPECT_EQ(run(words + Words{"--out", "cut"}), 4);
  EXPECT_NE(err().find("frames.extxyz: cannot be written: File too large"), std::string::npos)
      << err();
  EXPECT_NE(err().find("go on from there with: bounce resume cut\n"), std::string::npos) << err();
  EXPECT_EQ(lines(err()), 2) << err();
  largest_file_ = 0;
  EXPECT_EQ(run({"resume", "cut", "-q"}), 0) << err();
  expect_same_files("whole", "cut");
}

TEST_F(DriverResumeTest, AFullDiskEndsARunThatCanGoOn) {
  const Words words =
      Words{"run", "example-2", "-q", "--t-end", "1.5", "--checkpoint-every", "0.01"} +
      to_the_floor;
  ASSERT_EQ(run(words + Words{"--out", "whole"}), 0) << err();
  fs::create_directory(folder_ / "disk");
  if (mount("none", (folder_ / "disk").c_str(), "tmpfs", 0, "size=600k") != 0) {
    GTEST_SKIP() << "no disk of its own can be made here";
  }
  EXPECT_EQ(run(words + Words{"--out", "disk/cut"}), 4);
  EXPECT_NE(err().find("cannot be written: No space left on device"), std::string::npos) << err();
  EXPECT_NE(err().find("go on from there with: bounce resume disk/cut\n"), std::string::npos)
      << err();
  fs::copy(folder_ / "disk/cut.part", folder_ / "cut.part");
  umount((folder_ / "disk").c_str());
  EXPECT_EQ(run({"resume", "cut", "-q"}), 0) << err();
  expect_same_files("whole", "cut");
}

TEST_F(DriverResumeTest, AFolderThatIsRemovedIsAnErrorNotACrash) {
  const pid_t child = start(
      {"run", "example-2", "-q", "--t-end", "3000", "--out", "gone", "--checkpoint-every", "0.05"});
  wait_for("gone.part/checkpoint");
  fs::rename(folder_ / "gone.part", folder_ / "elsewhere");
  EXPECT_EQ(finish(child), 4) << err();
  EXPECT_NE(err().find("gone.part/checkpoint: cannot be written: No such file"), std::string::npos)
      << err();
}

TEST_F(DriverResumeTest, WhereThereIsNothingToGoOnWith) {
  EXPECT_EQ(run({"resume", "nothing"}), 2);
  EXPECT_NE(err().find("nothing: there is no run to go on with"), std::string::npos) << err();
  EXPECT_EQ(names(), Words{});
  ASSERT_EQ(
      run({"run", "example-2", "--steps", "10", "-q", "--out", "r", "--checkpoint-every", "0"}), 0);
  EXPECT_FALSE(fs::exists(folder_ / "r/checkpoint"));
  EXPECT_EQ(run({"resume", "r"}), 2);
  EXPECT_NE(err().find("r: there is no run to go on with"), std::string::npos) << err();
}

TEST_F(DriverResumeTest, ACheckpointThatIsNotTheRunsIsRefused) {
  ASSERT_EQ(run({"run", "example-2", "--steps", "1000", "-q", "--out", "r"}), 0) << err();
  const auto refused = [this](const std::string& why) {
    EXPECT_EQ(run({"resume", "r", "-q", "--steps", "2000"}), 2);
    EXPECT_NE(err().find(why), std::string::npos) << err();
  };
  const std::string scene = contents(folder_ / "r/scene.toml");
  std::ofstream(folder_ / "r/scene.toml") << scene << "# a remark changes nothing\n";
  EXPECT_EQ(run({"resume", "r", "-q"}), 0) << err();
  std::string other = scene;
  other.replace(other.find("elasticity = 16000"), 18, "elasticity = 16001");
  std::ofstream(folder_ / "r/scene.toml") << other;
  refused("r/scene.toml: is not the scene of the checkpoint");
  std::ofstream(folder_ / "r/scene.toml") << scene;
  const std::string rows = contents(folder_ / "r/monitor.csv");
  std::ofstream(folder_ / "r/monitor.csv") << rows.substr(0, 100);
  EXPECT_EQ(run({"resume", "r", "-q", "--steps", "2000"}), 4);
  EXPECT_NE(err().find("r/monitor.csv: holds 100 bytes, and held "), std::string::npos) << err();
  std::ofstream(folder_ / "r/monitor.csv") << rows;
  std::string bytes = contents(folder_ / "r/checkpoint");
  fs::copy(folder_ / "r/checkpoint", folder_ / "r/checkpoint.before");
  std::ofstream(folder_ / "r/checkpoint") << bytes.substr(0, bytes.size() / 2);
  refused("r/checkpoint: is not whole");
  EXPECT_NE(err().find("the one before it, of step 1000"), std::string::npos) << err();
  EXPECT_NE(err().find("\"bounce resume --before "), std::string::npos) << err();
  EXPECT_EQ(run({"resume", "r", "-q", "--before", "--steps", "2000"}), 0) << err();
  EXPECT_EQ(entry(folder_ / "r/run.json", "steps"), "2000");
}

}  // namespace
}  // namespace bounce
