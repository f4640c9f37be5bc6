// bounce stability as a user runs it.
#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

// All but the last column, which is a time.
std::string without_seconds(const fs::path& csv) {
  std::ifstream file(csv);
  std::string text;
  for (std::string line; std::getline(file, line);) {
    text += line.substr(0, line.rfind(',')) + "\n";
  }
  return text;
}

class DriverStabilityTest : public ProgramTest {
 protected:
  pid_t start(Words words) {
    words.insert(words.begin(), "stability");
    return ProgramTest::start(words);
  }
  int run(const Words& words) { return finish(start(words)); }
  // Runs until so many rows are there, then sends the signal. The exit code as finish() gives it.
  int run_until(const Words& words, const fs::path& journal, std::ptrdiff_t rows, int signal) {
    const pid_t child = start(words);
    for (int wait = 0; wait < 6000 && lines(contents(folder_ / journal)) <= rows; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    kill(child, signal);
    return finish(child);
  }
};

// More than one batch of flights, so that there is something to stop between.
Words many(const std::string& out) {
  return {"example-2", "--count", "40", "--flight-only", "--disturbed",     "0.02", "--periods",
          "300",       "--out",   out,  "--methods",     "listing,leapfrog"};
}

TEST_F(DriverStabilityTest, WritesItsDirectory) {
  ASSERT_EQ(run({"example-2", "--quick", "--set", "law.elasticity=1e6", "--periods", "100",
                 "--growth", "50", "--methods", "listing,leapfrog"}),
            0)
      << err();
  const fs::path at = folder_ / "runs/example-2-stability";
  const std::string csv = contents(at / "edge.csv");
  EXPECT_EQ(csv.substr(0, 18), "method,passage,sou");
  EXPECT_NE(csv.find("\nleapfrog,bounce,E,,1e-06,"), std::string::npos) << csv;
  for (const char* name : {"origin.json", "scene.toml", "table.txt"}) {
    EXPECT_TRUE(fs::exists(at / name)) << name;
  }
  EXPECT_EQ(names("runs"), Words{"example-2-stability"});
  EXPECT_NE(out().find(contents(at / "table.txt")), std::string::npos);
  EXPECT_NE(out().find("more than 50 times"), std::string::npos) << out();
  EXPECT_EQ(out().find("DEPENDS"), std::string::npos) << out();
  EXPECT_NE(contents(at / "origin.json").find("\"commit\""), std::string::npos);
  // What is there is not overwritten unasked.
  EXPECT_EQ(run({"example-2", "--quick"}), 2);
  EXPECT_NE(err().find("--force"), std::string::npos) << err();
}

// The columns hold both predictions, and the table the flights that show the strict one.
TEST_F(DriverStabilityTest, ShowsTheStrictLimitBesideTheCriterion) {
  ASSERT_EQ(run({"example-2", "--flight-only", "--e", "16000", "--no-disturbed", "--methods",
                 "leapfrog,blanes-moan-4", "--out", "s"}),
            0)
      << err();
  const std::string csv = contents(folder_ / "s/edge.csv");
  EXPECT_NE(csv.find(",predicted,strict,stable,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nblanes-moan-4,flight,dt,16000,,0,0,1e-06,100,2400,found,0.0006"),
            std::string::npos)
      << csv;
  EXPECT_EQ(csv.find("leapfrog,flight,dt,16000,,0,0,1e-06,100,2400"), std::string::npos) << csv;
  EXPECT_NE(out().find("The strict limit at E = 16000"), std::string::npos) << out();
  // Ten times as long flights show the window, too: said, not hidden.
  EXPECT_NE(out().find("DEPENDS"), std::string::npos) << out();
}

TEST_F(DriverStabilityTest, SameForAnyThreadsAndAfterAnyStop) {
  ASSERT_EQ(run(many("whole")), 0) << err();
  Words one = many("one");
  one.insert(one.end(), {"--threads", "1"});
  EXPECT_EQ(run(one), 0) << err();
  EXPECT_EQ(run_until(many("stopped"), "stopped.journal", 16, SIGINT), 130) << err();
  EXPECT_NE(err().find("goes on"), std::string::npos) << err();
  EXPECT_EQ(run_until(many("stopped"), "stopped.journal", 32, SIGKILL), 1000 + SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "stopped"));
  // Killed in the middle of a row.
  std::ofstream(folder_ / "stopped.journal", std::ios::app) << "[\"leapfrog,flight,dt,99";
  EXPECT_EQ(finish(ProgramTest::start({"resume", "stopped"})), 0) << err();
  EXPECT_FALSE(fs::exists(folder_ / "stopped.journal"));
  EXPECT_NE(err().find("going on"), std::string::npos) << err();
  const std::string whole = without_seconds(folder_ / "whole/edge.csv");
  EXPECT_GT(lines(whole), 80U);
  EXPECT_EQ(without_seconds(folder_ / "one/edge.csv"), whole);
  EXPECT_EQ(without_seconds(folder_ / "stopped/edge.csv"), whole);
}

TEST_F(DriverStabilityTest, KeepsAStoppedSweepFromOtherArguments) {
  EXPECT_EQ(run_until(many("s"), "s.journal", 16, SIGKILL), 1000 + SIGKILL);
  Words other = many("s");
  other[2] = "2";
  EXPECT_EQ(run(other), 2);
  EXPECT_NE(err().find("other arguments"), std::string::npos) << err();
  other.emplace_back("--force");
  EXPECT_EQ(run(other), 0) << err();
}

TEST_F(DriverStabilityTest, LawsWithoutRingKernelsAreMeasuredToo) {
  ASSERT_EQ(run({"example-2",
                 "--set",
                 "law.p=1",
                 "--set",
                 "law.q=4.5",
                 "--set",
                 "law.rest=geometry",
                 "--set",
                 "ball.radii=[5.0,6.0]",
                 "--set",
                 "ball.per_ring=30",
                 "--e",
                 "1000",
                 "--flight-only",
                 "--disturbed",
                 "0.001",
                 "--periods",
                 "50",
                 "--methods",
                 "leapfrog",
                 "--out",
                 "s"}),
            0)
      << err();
  EXPECT_NE(contents(folder_ / "s/edge.csv").find(",found,"), std::string::npos);
}

// Hundreds of bounces side by side: trials take the rule that does the same in the ball's kernels.
TEST_F(DriverStabilityTest, LocatedContactIsMeasuredAsResolved) {
  for (const std::string contact : {"resolved", "located"}) {
    ASSERT_EQ(run({"example-2", "--quick", "--set", "law.elasticity=1e6", "--periods", "100",
                   "--set", "wall.contact=" + contact, "--methods", "leapfrog", "--out", contact}),
              0)
        << err();
  }
  const std::string resolved = without_seconds(folder_ / "resolved/edge.csv");
  EXPECT_NE(resolved.find("\nleapfrog,bounce,E,,1e-06,"), std::string::npos) << resolved;
  EXPECT_EQ(without_seconds(folder_ / "located/edge.csv"), resolved);
}

TEST_F(DriverStabilityTest, BadInputIsSaid) {
  const auto refused = [this](Words words, const std::string& why) {
    words.insert(words.begin(), "example-2");
    EXPECT_EQ(run(words), 2) << why;
    EXPECT_NE(err().find(why), std::string::npos) << err();
    EXPECT_EQ(out(), "");
  };
  refused({"--methods", "magic"}, "--methods magic");
  refused({"--e", "0"}, "--e 0");
  refused({"--e", "nan"}, "--e nan");
  refused({"--e", "10", "--count", "3"}, "--count");
  refused({"--e-from", "10", "--e-to", "1"}, "--e-to 1");
  refused({"--count", "0"}, "--count 0");
  refused({"--dt", "-1"}, "--dt -1");
  refused({"--speed", "0"}, "--speed 0");
  refused({"--g", "-1"}, "--g -1");
  refused({"--growth", "0"}, "--growth 0");
  refused({"--periods", "inf"}, "--periods inf");
  refused({"--disturbed", "0"}, "--disturbed 0");
  refused({"--threads", "-3"}, "threads");
  refused({"--no-disturbed", "--disturbed", "0.1"}, "disturbed");
  refused({"--json"}, "--predict");
  refused({"--predict", "--quick"}, "--predict");
  refused({"--out", "/dev/null/x"}, "/dev/null/x");
  EXPECT_FALSE(fs::exists(folder_ / "runs"));
}

}  // namespace
}  // namespace bounce
