// What bounce run refuses, and that it then leaves nothing behind.
#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

using DriverRefusalTest = ProgramTest;

TEST_F(DriverRefusalTest, ABallThatMemoryCannotHoldIsRefusedBeforeItIsBuilt) {
  const Words words{"run",   "large-ball",        "--steps", "1", "--set", "ball.per_ring=3000000",
                    "--set", "ball.rounding=none"};
  memory_ = rlim_t{1} << 30;
  const Words ball(words.begin() + 4, words.end());
  std::vector<Words> all{words};
  for (const Words& start : std::vector<Words>{{"run", "large-ball", "--error", "1"},
                                               {"accuracy", "large-ball"},
                                               {"advise", "large-ball", "--error", "1"},
                                               {"stability", "large-ball", "--quick"},
                                               {"reference", "large-ball"}}) {
    all.push_back(start);
    all.back().insert(all.back().end(), ball.begin(), ball.end());
  }
  for (const Words& each : all) {
    ASSERT_EQ(run(each), 2) << each[0] << err();
    EXPECT_NE(err().find("--set: ball.per_ring = 3000000: allowed is a ball of at most "),
              std::string::npos)
        << each[0] << err();
  }
  EXPECT_TRUE(names().empty());
}

TEST_F(DriverRefusalTest, BadInputExitsWith2AndLeavesNothing) {
  std::ofstream(folder_ / "bad.toml") << "[law]\nq = 1\n";
  std::ofstream(folder_ / "short.dat") << "      1.0000      2.0000      0.0000      0.0000\n";
  std::ofstream(folder_ / "words.dat") << "x\n";
  std::ofstream(folder_ / "wrong.csv") << "i,x,y,vx,vy\n1,0,0,0,0\n3,0,0,0,0\n";
  const Words before = names();
  struct Case {
    Words words;
    const char* message;
  };
  for (const Case& c : std::vector<Case>{
           {{}, "subcommand is required"},
           {{"run"}, "SCENE is required"},
           {{"fly"}, "fly: no such command"},
           {{"run", "example-22"}, "did you mean example-2?"},
           {{"run", "bad.toml"}, "bad.toml:2: law.q = 1"},
           {{"run", "example-2", "--set", "law.elasticty=1"}, "did you mean law.elasticity?"},
           {{"run", "example-2", "--steps", "0"}, "--steps 0"},
           {{"run", "example-2", "--steps", "x"}, "--steps"},
           {{"run", "example-2", "--t-end", "nan"}, "--t-end: time.end = nan"},
           {{"run", "example-2", "--t-end", "1e-9"}, "time.end = 1e-09: allowed is"},
           {{"run", "example-2", "--steps", "5", "--t-end", "1"}, "excludes"},
           {{"run", "example-2", "--kernel", "warp"}, "no such kernel"},
           {{"run", "example-2", "--vector", "sse"}, "--vector sse"},
           {{"run", "example-2", "--threads", "-1"}, "--threads"},
           {{"run", "law-2-4", "--kernel", "oracle"}, "oracle"},
           {{"run", "example-2", "--initial", "none.dat"}, "none.dat: cannot be read"},
           {{"run", "example-2", "--initial", "short.dat"},
            "short.dat: initial state = 1 particles"},
           {{"run", "example-2", "--initial", "words.dat"}, "words.dat: "},
           {{"run", "example-2", "--initial", "wrong.csv"}, "wrong.csv:3: i = \"3\": allowed is 2"},
           {{"run", "example-2", "--set", "ball.centre=[0,2]"}, "wall[0] = a wall that particle"},
           {{"run", "example-2", "--final-state", "no/such/folder.csv"}, "is not a folder"},
           {{"run", "example-2", "--out", "bad.toml"}, "exists already"},
           {{"run", "example-2", "--out", "bad.toml", "--force"}, "is not the directory of a run"},
           {{"run", "example-2", "--out", ".", "--force"}, "is not the directory of a run"},
           {{"run", "example-2", "--out", "bad.toml/sub"}, "cannot be made there"},
       }) {
    EXPECT_EQ(run(c.words), 2) << c.message;
    EXPECT_NE(err().find(c.message), std::string::npos) << c.message << " not in: " << err();
    EXPECT_EQ(names(), before) << c.message;
  }
  EXPECT_EQ(contents(folder_ / "bad.toml"), "[law]\nq = 1\n");
}

TEST_F(DriverRefusalTest, NothingIsOverwrittenWithoutForce) {
  const Words first{"run", "example-2", "--steps", "10", "--out", "r", "--final-state", "f.csv"};
  ASSERT_EQ(run(first), 0) << err();
  const std::string json = contents(folder_ / "r/run.json");
  const std::string state = contents(folder_ / "f.csv");
  EXPECT_EQ(run({"run", "example-2", "--steps", "20", "--out", "r"}), 2);
  EXPECT_NE(err().find("--force"), std::string::npos);
  EXPECT_EQ(run({"run", "example-2", "--steps", "20", "--out", "s", "--final-state", "f.csv"}), 2);
  EXPECT_NE(err().find("--force"), std::string::npos);
  EXPECT_EQ(contents(folder_ / "r/run.json"), json);
  EXPECT_EQ(contents(folder_ / "f.csv"), state);
  EXPECT_EQ(names(), (Words{"f.csv", "r"}));
  ASSERT_EQ(run({"run", "example-2", "--steps", "20", "--out", "r/", "--final-state", "f.csv",
                 "--force"}),
            0)
      << err();
  EXPECT_EQ(entry(folder_ / "r/run.json", "steps"), "20");
  EXPECT_NE(contents(folder_ / "f.csv"), state);
  EXPECT_EQ(contents(folder_ / "f.csv"), contents(folder_ / "r/final.csv"));
  EXPECT_EQ(names(), (Words{"f.csv", "r"}));
}

TEST_F(DriverRefusalTest, AFullDiskIsAnErrorThatLeavesNothing) {
  largest_file_ = 4096;  // scene.toml fits, a frame does not
  EXPECT_EQ(run({"run", "example-2", "--steps", "10"}), 4);
  EXPECT_NE(err().find("frames.extxyz: cannot be written: "), std::string::npos) << err();
  EXPECT_EQ(names(), Words{});
}

// Radii of 0.02 cm: four decimals would strain the shortest bonds, 0.001 cm long, by a tenth.
TEST_F(DriverRefusalTest, ARoundingThatStrainsTheBall) {
  const auto write = [this](const std::string& more) {
    std::ofstream(folder_ / "tiny.toml")
        << "[ball]\nradii = [0.02, 0.024, 0.028]\ncentre = [0.0, 0.03]\n" + more +
               "[law]\nelasticity = 1e-6\nrest = \"geometry\"\n[time]\nmethod = \"leapfrog\"\n"
               "step = 1e-6\nend = 1e-5\n[output]\nmonitor_every = 1e-5\n";
  };
  write("");
  EXPECT_EQ(run({"run", "tiny.toml", "--quiet", "--out", "r"}), 0) << err();
  EXPECT_NE(contents(folder_ / "r/scene.toml").find("rounding = \"none\""), std::string::npos);
  write("rounding = \"listing\"\n");
  EXPECT_EQ(run({"run", "tiny.toml", "--quiet", "--out", "s"}), 2);
  EXPECT_NE(err().find("tiny.toml:4: ball.rounding = \"listing\": allowed is \"none\""),
            std::string::npos)
      << err();
}

}  // namespace
}  // namespace bounce
