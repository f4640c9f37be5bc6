// The rows of `bounce extremes`: what they expect, against what physics predicts; and the command.
#include <cmath>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "driver/extremes/extreme_row.hpp"
#include "driver/extremes/extreme_table.hpp"
#include "driver/scene/step_check.hpp"
#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

// Rows that are not refused can be started; and a run is refused, or has to be forced, exactly
// where the spectrum of its start says that the step is beyond the edge.
TEST(ExtremeRows, ExpectWhatTheSpectrumPredicts) {
  for (const ExtremeRow& row : extreme_rows()) {
    if (row.says.starts_with("wall[")) {
      EXPECT_THROW(make_problem(row.scene, start_of(row)), SceneError) << row.name;
      EXPECT_EQ(row.expected, Outcome::refused) << row.name;
      continue;
    }
    const Problem problem = make_problem(row.scene, start_of(row));
    const auto check = check_step(problem);
    ASSERT_TRUE(check) << row.name;
    const bool stable = check->part <= 1.0;
    EXPECT_EQ(row.expected == Outcome::complete, stable) << row.name << ": " << check->part;
    EXPECT_EQ(row.expected == Outcome::stops, !stable && row.force) << row.name;
  }
}

// Issue 4's list: a row that is lost is noticed.
TEST(ExtremeRows, CoverTheList) {
  std::set<std::string> names;
  for (const ExtremeRow& row : extreme_rows()) {
    names.insert(row.name);
    EXPECT_TRUE(row.like.empty() || names.count(row.like) == 1) << row.name;
  }
  for (const char* name :
       {"elasticity-1e-6",  "elasticity-1e12", "impact-1",      "impact-10",    "impact-100",
        "impact-1000",      "gravity-none",    "gravity-1e4",   "law-7-13",     "law-2-4",
        "radii-10-11-12",   "radii-0.05",      "rings-1e-6",    "bond-1e-3",    "bond-1e-8",
        "bond-1e3",         "wall-behind",     "wall-touching", "wall-resting", "wall-wedge",
        "gravity-collapse", "offset-1e6",      "offset-1e9"}) {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
  for (const Method& method : methods()) {
    const std::string name(method.name);
    for (const std::string& row :
         {"edge-below-" + name, "edge-above-" + name, "edge-above-" + name + "-forced"}) {
      EXPECT_EQ(names.count(row), 1U) << row;
    }
  }
}

TEST(ExtremeRows, MoveTheFirstBondAlone) {
  for (const ExtremeRow& row : extreme_rows()) {
    const auto start = start_of(row);
    EXPECT_EQ(start.has_value(), row.first_bond.has_value()) << row.name;
    if (!start) continue;
    const State ball = make_problem(row.scene).initial;
    const double distance = std::hypot(start->x[0] - start->x[1], start->y[0] - start->y[1]);
    EXPECT_NEAR(distance / (*row.first_bond * std::sqrt(0.06854)), 1.0, 1e-6) << row.name;
    for (std::size_t i = 1; i < ball.size(); ++i) {
      EXPECT_TRUE(start->x[i] == ball.x[i] && start->y[i] == ball.y[i]) << row.name;
    }
  }
}

TEST(ExtremeRows, BadOnesAreRefusedByName) {
  const std::string good = "[extreme]\ngroup = \"wall\"\nexpect = \"complete\"\nbecause = \"so\"\n";
  EXPECT_NO_THROW(read_extreme_row("x", good));
  for (const std::string& bad :
       {std::string("title = \"none\"\n"), good + "colour = 1\n", good + "booked = -1\n",
        good + "first_bond = 0.0\n", good + "first_bond = nan\n", good + "quick = 1\n",
        std::string("[extreme]\ngroup = \"wall\"\nexpect = \"well\"\nbecause = \"so\"\n"),
        std::string("[extreme]\ngroup = \"all\"\nexpect = \"stops\"\nbecause = \"so\"\n"),
        std::string("[extreme]\ngroup = \"wall\"\nexpect = \"stops\"\n")}) {
    EXPECT_THROW(read_extreme_row("x", bad), InputError) << bad;
  }
}

// The program as a user runs it.
class ExtremesCommand : public ProgramTest {
 protected:
  // Words with blanks between them.
  int run(const std::string& text) {
    std::istringstream from(text);
    Words words;
    for (std::string word; from >> word;) words.push_back(word);
    return ProgramTest::run(words);
  }
  [[nodiscard]] std::string said() const { return out() + err(); }
};

TEST_F(ExtremesCommand, TheQuickRowsDoWhatIsExpected) {
  ASSERT_EQ(run("extremes --quick --out r"), 0) << said();
  EXPECT_EQ(said().find("FAILED"), std::string::npos) << said();
  EXPECT_TRUE(fs::exists(folder_ / "r/extremes.csv"));
  EXPECT_TRUE(fs::exists(folder_ / "r/extremes.md"));
}

TEST_F(ExtremesCommand, RunsOneRowAndKeepsItsFiles) {
  ASSERT_EQ(run("extremes --only edge-above-leapfrog-forced --runs r"), 0) << said();
  EXPECT_NE(said().find("1 of 1 rows as expected"), std::string::npos) << said();
  EXPECT_TRUE(fs::exists(folder_ / "r/edge-above-leapfrog-forced/run.json"));
  EXPECT_TRUE(fs::exists(folder_ / "r/edge-above-leapfrog-forced-on/run.json"));
  EXPECT_EQ(run("extremes --only edge-above-leapfrog-forced --runs r"), 2);  // r is there
  EXPECT_EQ(run("extremes --only edge-abov"), 2);
  EXPECT_NE(said().find("no such row"), std::string::npos) << said();
  // A row is a scene that can be run by itself.
  EXPECT_EQ(run("run extremes/edge-above-leapfrog"), 2);
  EXPECT_EQ(run("run extremes/edge-below-leapfrog --steps 10 --quiet"), 0) << said();
}

// Rows of one's own, each expecting what does not happen.
TEST_F(ExtremesCommand, ARowThatDiffersIsAFailure) {
  const auto row = [this](const std::string& extreme, const std::string& scene) {
    std::ofstream(folder_ / "mine.toml") << "[extreme]\ngroup = \"edge\"\nbecause = \"so\"\n"
                                         << extreme << "\n[time]\n"
                                         << scene << "\n[output]\nmonitor_every = 0.01\n";
    return run("extremes --only mine.toml --out r");
  };
  const std::string stable = "step = 1e-6\nend = 0.001", unstable = "step = 3.9e-4\nend = 1.0";
  EXPECT_EQ(row("expect = \"complete\"\nbooked = 100", stable), 0) << said();
  EXPECT_EQ(row("expect = \"refused\"", stable), 1) << said();
  EXPECT_EQ(row("expect = \"stops\"", stable), 1) << said();
  EXPECT_EQ(row("expect = \"refused\"", unstable), 0) << said();
  EXPECT_EQ(row("expect = \"complete\"", unstable), 1) << said();
  EXPECT_EQ(row("expect = \"refused\"\nsays = \"the moon\"", unstable), 1) << said();
  EXPECT_EQ(row("expect = \"stops\"\nforce = true", unstable), 0) << said();
  EXPECT_EQ(row("expect = \"complete\"\nforce = true", unstable), 1) << said();
  EXPECT_NE(said().find("FAILED"), std::string::npos) << said();
  EXPECT_NE(said().find("0 of 1 rows as expected"), std::string::npos) << said();
  EXPECT_EQ(row("expect = \"stops\"\nforce = true\nsays = \"the moon\"", unstable), 1) << said();
  // A row like another that is not as far off as it may be, and one that is farther.
  std::ofstream(folder_ / "mine.toml")
      << "[extreme]\ngroup = \"offset\"\nbecause = \"so\"\nexpect = \"complete\"\nlike = "
         "\"offset-0\"\n[ball]\ncentre = [1e6, 1e6]\nrounding = \"none\"\nvelocity = [1.0, "
         "0.0]\n[time]\nend = 0.5\n[output]\nmonitor_every = 0.001\n";
  EXPECT_EQ(run("extremes --only mine.toml"), 1) << said();
  EXPECT_NE(said().find("TOO FAR"), std::string::npos) << said();
}

}  // namespace
}  // namespace bounce
