// How a time step is judged: before a run starts, on its way, and when it has become unstable.
#include "driver/scene/state_file.hpp"
#include "verify/tests/driver/program_test.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

using DriverStepTest = ProgramTest;

// Example 2 at its start: omega_max = 5221 1/s, stable step 3.83e-4 s.
TEST_F(DriverStepTest, AStepBeyondTheEdgeIsRefusedAndOneNearItWarnedOf) {
  const auto words = [](const std::string& step, Words more) {
    Words all{"run",   "example-2",        "--steps", "20", "--set", "output.monitor_every=1",
              "--set", "time.step=" + step};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  EXPECT_EQ(run(words("3.9e-4", {"--set", "time.method=leapfrog"})), 2);
  for (const char* part : {"--set: time.step = 0.00039: allowed is at most 0.0003831 s",
                           "method leapfrog", "omega_max = 5221 1/s", "--force"}) {
    EXPECT_NE(err().find(part), std::string::npos) << part << " not in: " << err();
  }
  EXPECT_EQ(names(), Words{});
  // Just within: warned of, and run. Below one half: nothing on stderr.
  ASSERT_EQ(run(words("3.8e-4", {"--out", "a"})), 0) << err();
  EXPECT_NE(err().find("warning: time.step = 0.00038 is 0.992 of the stable step"),
            std::string::npos)
      << err();
  ASSERT_EQ(run(words("3.8e-4", {"--out", "b", "--quiet"})), 0);
  EXPECT_EQ(out() + err(), "");
  ASSERT_EQ(run(words("1.9e-4", {"--out", "c"})), 0);
  EXPECT_EQ(err(), "");
  // Beyond, with --force: told of, run, and kept. It takes more than 20 steps to become unstable.
  ASSERT_EQ(run(words("3.84e-4", {"--force", "--out", "d"})), 0) << err();
  EXPECT_NE(err().find("is 1.002 of the stable step 0.0003831 s; it is run all the same (--force)"),
            std::string::npos)
      << err();
}

// Far away the last place of a position is as long as a step.
TEST_F(DriverStepTest, MotionThatRoundingLosesIsWarnedOf) {
  const auto at = [](const std::string& place) {
    return Words{"run",     "example-2",
                 "--steps", "20000",
                 "--set",   "wall=[]",
                 "--set",   "ball.rounding=none",
                 "--set",   "ball.centre=[" + place + ", 0]",
                 "--out",   "r" + place};
  };
  ASSERT_EQ(run(at("1e3")), 0);
  EXPECT_EQ(err(), "");
  ASSERT_EQ(run(at("1e9")), 0);
  EXPECT_NE(
      err().find("warning: positions of 1e+09 cm are rounded to 1.2e-07 cm: what is slower than "
                 "0.06 cm/s does not move in a step of 1e-06 s, and 0.0012 cm may get lost"),
      std::string::npos)
      << err();
}

TEST_F(DriverStepTest, ARunTellsItsPartOfTheStableStep) {
  ASSERT_EQ(run({"run", "example-2", "--steps", "20000", "--out", "r"}), 0) << err();
  EXPECT_NE(out().find("time step: 0.0026 of the stable step of listing at the start, 0.0003831 s"),
            std::string::npos)
      << out();
  EXPECT_NE(out().find("greatest part of the stable step used: 0.00261 at t = "), std::string::npos)
      << out();
  const std::string json = contents(folder_ / "r/run.json");
  for (const char* part :
       {"\"stability\": {\n    \"omega_max\": 5221.1757", "\"omega_max_from\": \"lanczos\"",
        "\"stable_step\": 0.00038305", "\"part\": 0.0026105", "\"greatest_part\": {",
        "\"at_most\": 0.0026", "\"bond\": ["}) {
    EXPECT_NE(json.find(part), std::string::npos) << part << " not in: " << json;
  }
  // The last column of monitor.csv: the part by the bound, a little more.
  std::istringstream monitor(contents(folder_ / "r/monitor.csv"));
  std::string row;
  std::getline(monitor, row);
  EXPECT_EQ(row.substr(row.rfind(',')), ",stable_part");
  int rows = 0;
  for (; std::getline(monitor, row); ++rows) {
    const double part = std::stod(row.substr(row.rfind(',') + 1));
    EXPECT_TRUE(part >= 0.002610 && part <= 0.002620) << row;
  }
  EXPECT_EQ(rows, 3);
}

TEST_F(DriverStepTest, AnUnstableRunExitsWith3AndKeepsTheLastGoodState) {
  const Words words{"run",     "example-2",
                    "--set",   "time.step=3.9e-4",
                    "--set",   "time.method=leapfrog",
                    "--set",   "output.monitor_every=1",
                    "--force", "--out"};
  Words first = words;
  first.push_back("r");
  ASSERT_EQ(run(first), 3) << err();
  EXPECT_NE(err().find("unstable at step "), std::string::npos) << err();
  EXPECT_EQ(entry(folder_ / "r/run.json", "status"), "\"unstable\"");
  EXPECT_EQ(lines(contents(folder_ / "r/final.csv")), 361U);
  EXPECT_EQ(contents(folder_ / "r/final.csv").find("nan"), std::string::npos);
  // The step is the first bad one: a run that ends just before it, watched at its end only, is
  // complete, and ends in the state that was kept; one step more is refused.
  const long good = std::stol(entry(folder_ / "r/run.json", "steps"));
  EXPECT_NE(err().find("unstable at step " + std::to_string(good + 1) + " "), std::string::npos)
      << err();
  ASSERT_GE(good,
            2);  // else the bisection had nothing to do: choose a step nearer to the stable one
  EXPECT_NE(err().find("bond "), std::string::npos) << err();
  EXPECT_NE(err().find("particle "), std::string::npos) << err();
  Words to_good = words;
  to_good.insert(to_good.end(), {"s", "--steps", std::to_string(good)});
  EXPECT_EQ(run(to_good), 0) << err();
  EXPECT_EQ(contents(folder_ / "r/final.csv"), contents(folder_ / "s/final.csv"));
  Words to_bad = words;
  to_bad.insert(to_bad.end(), {"t", "--steps", std::to_string(good + 1)});
  EXPECT_EQ(run(to_bad), 3);
}

TEST_F(DriverStepTest, AnUnstableRunWithBooksEndsAsWithout) {
  const Words words{"run",
                    "example-2",
                    "--force",
                    "--set",
                    "time.step=3.9e-4",
                    "--set",
                    "time.method=leapfrog",
                    "--set",
                    "output.monitor_every=1"};
  Words plain = words, booked = words;
  plain.insert(plain.end(), {"--out", "r"});
  booked.insert(booked.end(), {"--ledger", "--out", "s"});
  ASSERT_EQ(run(plain), 3) << err();
  ASSERT_EQ(run(booked), 3) << err();
  EXPECT_EQ(contents(folder_ / "r/final.csv"), contents(folder_ / "s/final.csv"));
}

// The number after `"key": ` behind the first `"object": {` of a JSON text, as it stands there.
std::string number_in(const std::string& text, const std::string& object, const std::string& key) {
  const auto from = text.find("\"" + key + "\": ", text.find("\"" + object + "\": {"));
  if (from == std::string::npos) return "";
  const auto at = from + key.size() + 4;
  return text.substr(at, text.find_first_of(",\n", at) - at);
}

TEST_F(DriverStepTest, AStoppedRunGoesOnFromItsLastGoodStateAsItIsTold) {
  for (const std::string method : {"listing", "leapfrog"}) {
    ASSERT_EQ(run({"run", "example-2", "--set", "time.step=3.9e-4", "--set",
                   "time.method=" + method, "--force", "--out", "r"}),
              3);
    const std::string json = contents(folder_ / "r/run.json");
    for (const char* key : {"\"bond_class\": \"ring ", "\"ratio\": 0.", "\"energy_jump\": ",
                            "\"last_good\": {", "\"refused\": {", "\"stable_step\": 0.000"}) {
      EXPECT_NE(json.find(key), std::string::npos) << key << " not in: " << json;
    }
    // The command that it prints.
    const std::string start = "  bounce run ";
    const auto at = err().find(start);
    ASSERT_NE(at, std::string::npos) << err();
    std::istringstream line(err().substr(at + 9, err().find('\n', at) - at - 9));
    Words words;
    for (std::string word; line >> word;) words.push_back(word);
    words.insert(words.end(), {"--out", "on", "--steps", "20000", "--force"});
    ASSERT_EQ(run(words), 0) << err();
    EXPECT_NE(out().find("ledgers close"), std::string::npos) << out();
    // Nothing is lost between the two: not the half kick that leapfrog has pending.
    EXPECT_EQ(number_in(json, "last_good", "energy"),
              number_in(contents(folder_ / "on/run.json"), "energies_at_start", "total"));
    EXPECT_NE(number_in(json, "last_good", "energy"), "");
  }
}

TEST_F(DriverStepTest, StabilityIsPredicted) {
  ASSERT_EQ(run({"stability", "example-2", "--predict"}), 0) << err();
  for (const char* part : {"omega_max: 5221.1758 1/s", "leapfrog", "0.000383055",
                           "0.00261 of the stable step of listing"}) {
    EXPECT_NE(out().find(part), std::string::npos) << part << " not in: " << out();
  }
  // A hundred times the elasticity: ten times the frequency.
  ASSERT_EQ(run({"stability", "example-2", "--predict", "--json", "--set", "law.elasticity=1.6e6",
                 "--set", "time.method=leapfrog"}),
            0)
      << err();
  const fs::path json = folder_ / "stdout";
  EXPECT_NEAR(std::stod(entry(json, "omega_max")), 52211.76, 0.01);
  EXPECT_EQ(entry(json, "omega_max_from"), "\"lanczos\"");
  EXPECT_EQ(entry(json, "method"), "\"leapfrog\"");
  EXPECT_NEAR(std::stod(entry(json, "part")), 0.0261059, 1e-7);
  EXPECT_NE(out().find("\"stable_step\": {\n    \"listing\": 3.8305"), std::string::npos) << out();
  EXPECT_NE(out().find("\"leapfrog\": 3.8305"), std::string::npos) << out();
  EXPECT_EQ(out().substr(0, 2) + out().substr(out().size() - 3), "{\n\n}\n");  // nothing else
  // From a state: its own, the same to all digits.
  ASSERT_EQ(run({"run", "example-2", "--steps", "10", "--final-state", "s.csv", "--quiet"}), 0);
  ASSERT_EQ(run({"stability", "example-2", "--predict", "--json", "--initial", "s.csv"}), 0);
  EXPECT_EQ(entry(json, "initial"), "\"s.csv\"");
  EXPECT_NEAR(std::stod(entry(json, "omega_max")), 5221.1757, 1e-3);
  // Two particles in one place have no stable step, neither here nor in a run.
  std::istringstream rows(contents(folder_ / "s.csv"));
  std::ofstream bad(folder_ / "bad.csv");
  std::string row, before;
  for (int n = 0; std::getline(rows, row); ++n) {
    if (n == 2) row.replace(1, std::string::npos, before, 1);  // particle 2 where particle 1 is
    bad << row << '\n';
    before = row;
  }
  bad.close();
  for (const Words& words :
       {Words{"stability", "example-2", "--initial", "bad.csv", "--predict"},
        Words{"stability", "example-2", "--initial", "bad.csv", "--out", "bad"},
        Words{"run", "example-2", "--initial", "bad.csv", "--out", "bad"}}) {
    EXPECT_EQ(run(words), 2) << out();
    EXPECT_NE(err().find("bad.csv: initial state = a bond without a finite stiffness"),
              std::string::npos)
        << err();
  }
  EXPECT_EQ(run({"stability"}), 2);
  EXPECT_EQ(run({"stability", "example-22", "--predict"}), 2);
  EXPECT_EQ(run({"stability", "example-2", "--predict", "--set", "law.q=1"}), 2);
  EXPECT_EQ(run({"stability", "example-2", "--json"}), 2);
  EXPECT_NE(err().find("--predict"), std::string::npos) << err();
}

// A ball of four that bounces elastically: whether it counts as unstable is a matter of its motion,
// not of how often one looks.
TEST_F(DriverStepTest, InstabilityIsNoMatterOfTheMonitor) {
  std::ofstream(folder_ / "four.toml")
      << "[ball]\nradii = [1.0]\nper_ring = 4\ncentre = [0.0, 2.0]\n"
         "rounding = \"none\"\n[law]\nelasticity = 1000.0\n"
         "rest = \"geometry\"\n[gravity]\nacceleration = [0.0, -98.0]\n"
         "[[wall]]\nalpha = 1.0\nbeta = -1.0\n"
         "[time]\nstep = 1e-3\nend = 1.0\n";
  State first;
  for (const char* every : {"0.5", "0.25", "0.1", "0.01", "0.001"}) {
    ASSERT_EQ(run({"run", "four.toml", "--force", "--quiet", "--out", "r", "--set",
                   std::string("output.monitor_every=") + every}),
              0)
        << every << "\n"
        << err();
    const State found = read_state((folder_ / "r/final.csv").string()).state;
    if (first.size() == 0) first = found;
    EXPECT_TRUE(same_state(found, first)) << every;
  }
}

// 20 cm a step, through the wall and out again.
TEST_F(DriverStepTest, WhatCouldPassThroughAWallIsRefusedAndNoticed) {
  const Words words{"run",   "example-2",
                    "--out", "r",
                    "--set", "ball.velocity=[0.0, -2e5]",
                    "--set", "time.method=leapfrog",
                    "--set", "time.step=1e-4"};
  EXPECT_EQ(run(words), 2) << out();
  EXPECT_NE(err().find("time.step = 0.0001: allowed is at most 1.3e-06 s"), std::string::npos)
      << err();
  Words forced = words;
  forced.emplace_back("--force");
  EXPECT_EQ(run(forced), 3) << out();
  EXPECT_NE(err().find("may pass through a wall unnoticed"), std::string::npos) << err();
}

// It falls 1000 cm: at the start it is at rest, at the wall it would move by 1.7 neighbours a step.
TEST_F(DriverStepTest, TheSpeedAtTheWallCounts) {
  EXPECT_EQ(run({"run", "example-2", "--out", "r", "--set", "ball.centre=[0.0, 1007.0]", "--set",
                 "gravity.acceleration=[0.0, -1000.0]", "--set", "time.method=leapfrog", "--set",
                 "time.step=3e-4"}),
            2)
      << out();
  EXPECT_NE(err().find("comes to a wall at 1.41e+03 cm/s moves by 1.62 times"), std::string::npos)
      << err();
}

// A step that fails proposes at most half of it, so who follows the advice comes to one that does.
TEST_F(DriverStepTest, FollowingTheAdviceEnds) {
  std::string step = "2e-4";
  for (int tries = 0; tries < 8; ++tries) {
    const int code = run({"run", "example-2", "--force", "--quiet", "--out", "r", "--set",
                          "ball.velocity=[0.0, -1000.0]", "--set", "wall.contact=resolved", "--set",
                          "time.method=leapfrog", "--set", "time.step=" + step, "--t-end", "0.1"});
    if (code == 0) {
      EXPECT_GT(tries, 0) << "it was to fail at first";
      return;
    }
    ASSERT_EQ(code, 3) << err();
    const double advised = number_after(err(), "time.step=");
    ASSERT_GT(advised, 0.0) << err();
    ASSERT_LE(advised, 0.5 * std::stod(step) * (1.0 + 1e-12)) << err();
    step = std::to_string(advised * 1e9) + "e-9";
  }
  FAIL() << "eight times no step that does";
}

}  // namespace
}  // namespace bounce
