// bounce accuracy and bounce advise as a user runs them.
#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

class DriverAccuracyTest : public ProgramTest {
 protected:
  // Words with blanks between them.
  int run(const std::string& text, const std::string& command = "accuracy") {
    std::istringstream from(command + " " + text);
    Words words;
    for (std::string word; from >> word;) words.push_back(word);
    return ProgramTest::run(words);
  }
};

// The last 0.002 cm of Example 1's fall, and the first tenth of a second of its contact.
const std::string impact =
    "example-1 --set ball.centre=[0.0,7.002] --set ball.velocity=[0.0,-0.77] "
    "--set time.end=0.1 ";
const std::string short_course = impact + "--methods listing,leapfrog --quick ";

TEST_F(DriverAccuracyTest, WritesItsDirectory) {
  ASSERT_EQ(run(short_course), 0) << err();
  const fs::path at = folder_ / "runs/example-1-accuracy";
  const std::string csv = contents(at / "accuracy.csv");
  EXPECT_NE(csv.find("\nreference,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nlisting,listing,1e-06,,100000,100000,mirror,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nleapfrog,resolved,"), std::string::npos) << csv;
  EXPECT_EQ(contents(at / "table.txt") + "\nfiles: runs/example-1-accuracy\n", out());
  EXPECT_NE(out().find("times sooner"), std::string::npos) << out();
  EXPECT_NE(contents(at / "origin.json").find("\"oracle_seconds\": "), std::string::npos);
  EXPECT_TRUE(fs::exists(at / "scene.toml"));
  EXPECT_EQ(run(short_course), 2);  // it is there already
  EXPECT_NE(err().find("exists already"), std::string::npos) << err();
}

TEST_F(DriverAccuracyTest, HasTheBaselinesBesideTheMethods) {
  ASSERT_EQ(run(impact + "--methods conservative,gsl-rkf45 --quick"), 0) << err();
  const std::string csv = contents(folder_ / "runs/example-1-accuracy/accuracy.csv");
  for (const char* row : {"\nconservative,listing,", "\nconservative,resolved,", ",1e-04,",
                          "\ngsl-rkf45,located,", ",1e-06,", ",baseline,"}) {
    EXPECT_NE(csv.find(row), std::string::npos) << row << csv;
  }
  EXPECT_EQ(csv.find("\nleapfrog,"), std::string::npos) << csv;
}

TEST_F(DriverAccuracyTest, HasTheContactsOfEachMethod) {
  ASSERT_EQ(run(impact + "--methods leapfrog,yoshida-4,blanes-moan-6 --quick"), 0) << err();
  const std::string csv = contents(folder_ / "runs/example-1-accuracy/accuracy.csv");
  for (const char* row : {"\nleapfrog,listing,", "\nleapfrog,resolved,", "\nleapfrog,located,",
                          "\nyoshida-4,resolved,", "\nyoshida-4,located,", ",mirror,"}) {
    EXPECT_NE(csv.find(row), std::string::npos) << row << csv;
  }
  EXPECT_EQ(csv.find("\nyoshida-4,listing,"), std::string::npos) << csv;
  // Half of the 1.5 decades where contacts are located and there are many evaluations.
  EXPECT_EQ(count(csv, "\nblanes-moan-6,resolved,"), 4) << csv;
  EXPECT_EQ(count(csv, "\nleapfrog,located,"), 4) << csv;
  EXPECT_EQ(count(csv, "\nyoshida-4,located,"), 3) << csv;
}

// Between two looks a particle may come to an elastic floor and leave it. Before that the method
// has its own error, roundings at the smallest step; after it that of the contact, 1e-10 cm at
// least.
TEST_F(DriverAccuracyTest, ComparesPlacesBeforeTheFirstBounce) {
  ASSERT_EQ(run(impact + "--set wall.alpha=1 --set wall.beta=-1 --methods blanes-moan-6 --contacts "
                         "resolved --quick --every 0.002"),
            0)
      << err();
  const std::string csv = contents(folder_ / "runs/example-1-accuracy/accuracy.csv");
  std::istringstream row(csv.substr(csv.rfind("\nblanes-moan-6,") + 1));
  std::string field;
  for (int k = 0; k < 9; ++k) std::getline(row, field, ',');  // to error_position
  EXPECT_GT(std::stod(field), 0.0) << csv;
  EXPECT_LT(std::stod(field), 1e-12) << csv;
}

TEST_F(DriverAccuracyTest, HasTheContactsAskedFor) {
  ASSERT_EQ(run(impact + "--methods leapfrog --contacts located --quick"), 0) << err();
  const std::string csv = contents(folder_ / "runs/example-1-accuracy/accuracy.csv");
  EXPECT_EQ(count(csv, "\nleapfrog,"), 4) << csv;
  EXPECT_EQ(count(csv, "\nleapfrog,located,"), 4) << csv;
  EXPECT_EQ(count(csv, "\nlisting,listing,1e-06,"), 1) << csv;  // the paper's is always there
  ASSERT_EQ(run(impact + "--methods leapfrog,pefrl --contacts listing --quick --force"), 0)
      << err();
  EXPECT_NE(out().find("left out: pefrl: it has none of the contacts"), std::string::npos) << out();
}

TEST_F(DriverAccuracyTest, HasTheStepsAskedFor) {
  ASSERT_EQ(run(impact + "--methods yoshida-4 --steps 1e-4,2.5e-5 --quick"), 0) << err();
  const std::string csv = contents(folder_ / "runs/example-1-accuracy/accuracy.csv");
  EXPECT_NE(csv.find("\nyoshida-4,resolved,0.0001,,1000,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nyoshida-4,resolved,2.5e-05,,4000,"), std::string::npos) << csv;
}

// What the scene writes, and how often, is no matter of the study.
TEST_F(DriverAccuracyTest, LooksMayBeRarerThanTheScenesOwn) {
  ASSERT_EQ(run(impact + "--set time.end=0.2 --every 0.02 --methods leapfrog --contacts resolved "
                         "--quick"),
            0)
      << err();
  EXPECT_EQ(run(impact + "--error 1 --set output.monitor_every=0.001", "advise"), 0) << err();
  EXPECT_LE(number_after(out(), "time step "), 0.001) << out();  // 0.00138 would be stable
  EXPECT_EQ(run(impact + "--error 1 --set output.monitor_every=0.001 --out r", "run"), 0) << err();
}

TEST_F(DriverAccuracyTest, ThePapersProgramHasItsOwnStepOrIsLeftOut) {
  ASSERT_EQ(run(impact + "--set time.end=0.1234567 --methods leapfrog --contacts resolved "
                         "--quick"),
            0)
      << err();
  EXPECT_NE(out().find("left out: the paper's program: its step of 1e-06 s"), std::string::npos)
      << out();
  EXPECT_EQ(out().find("listing"), std::string::npos) << out();
}

TEST_F(DriverAccuracyTest, SaysWhatNoKernelCanRun) {
  const std::string corner =
      impact + "--set wall=[{alpha=1.0},{normal=[1.0,0.0],offset=-20.0,alpha=1.0}] ";
  ASSERT_EQ(run(corner + "--methods leapfrog --quick"), 0) << err();
  EXPECT_NE(out().find("left out: leapfrog, located: "), std::string::npos) << out();
  EXPECT_NE(out().find("slides along one wall"), std::string::npos) << out();
  const std::string csv = contents(folder_ / "runs/example-1-accuracy/accuracy.csv");
  EXPECT_NE(csv.find("\nleapfrog,resolved,"), std::string::npos) << csv;
  EXPECT_EQ(csv.find(",located,"), std::string::npos) << csv;
  EXPECT_NE(contents(folder_ / "runs/example-1-accuracy/origin.json").find("slides along one wall"),
            std::string::npos);
}

TEST_F(DriverAccuracyTest, TellsWhatIsWrongAndLeavesNothing) {
  const auto refused = [this](const std::string& words, const std::string& text) {
    EXPECT_EQ(run(words + " --out bad"), 2) << words;
    EXPECT_NE(err().find(text), std::string::npos) << err();
    EXPECT_FALSE(fs::exists(folder_ / "bad")) << words;
  };
  refused("example-1 --methods euler", "--methods euler: unknown; allowed is listing");
  refused("example-1 --contacts sticky",
          "--contacts sticky: unknown; allowed is \"listing\", \"resolved\" or \"located\"");
  refused("example-1 --steps 1e-4,3e-3", "--steps 0.003: allowed is a whole part of 0.01 s");
  refused("example-1 --steps 0", "--steps 0: allowed is a whole part");
  refused("example-1 --steps 0.02", "--steps 0.02: allowed is a whole part");
  refused("example-1 --every 0", "--every 0: allowed is above 0");
  refused("example-1 --every 14", "a tenth of time.end = 15");
  refused("example-1 --every 1e-6", "--every: 360 particles at 1.5e+07 times would take 518.4 GB");
  refused("example-1 --every 1e-300", "--every: 360 particles at ");
  refused("example-1 --decades nan", "--decades nan: allowed is above 0");
  refused("example-1 --per-decade 0", "--per-decade 0: allowed is 1 to 100");
  refused("example-1 --threads 1000", "allowed");
  refused("example-9", "example-9");
  refused("example-1 --set wall.contact=glue", "\"listing\", \"resolved\" or \"located\"");
}

// What was forecast comes out: the run's last row against the reference's height.
TEST_F(DriverAccuracyTest, AdviceIsTakenAndTrue) {
  ASSERT_EQ(run(short_course), 0) << err();
  const double height = number_after(out(), "  height ");
  ASSERT_EQ(run(impact + "--error 1e-6", "advise"), 0) << err();
  const std::string advised = out().substr(out().find("time.method="));
  const double forecast = number_after(out(), "error of height ");
  EXPECT_LE(forecast, 1e-6);
  ASSERT_EQ(run(impact + "--error 1e-6 --out there", "run"), 0) << err();
  const std::string scene = contents(folder_ / "there/scene.toml");
  EXPECT_EQ(scene.find("contact = \"listing\""), std::string::npos) << scene;
  const std::string monitor = contents(folder_ / "there/monitor.csv");
  const std::string last = monitor.substr(monitor.rfind('\n', monitor.size() - 2) + 1);
  // The column of the centre's height, by the head.
  std::stringstream head(monitor.substr(0, monitor.find('\n'))), row(last);
  std::string name, value;
  double reached = std::nan("");
  while (std::getline(head, name, ',') && std::getline(row, value, ',')) {
    if (name == "cy") reached = std::strtod(value.c_str(), nullptr);
  }
  EXPECT_NEAR(reached, height, 3e-6);  // at most three times what was asked
  EXPECT_NE(contents(folder_ / "there/run.json").find("\"advice\""), std::string::npos);
}

// --ledger books every reflection, for which contacts must not be located.
TEST_F(DriverAccuracyTest, AdviceLeavesRoomForBooks) {
  ASSERT_EQ(run(impact + "--error 1e-3 --ledger --out there", "run"), 0) << err();
  EXPECT_NE(contents(folder_ / "there/scene.toml").find("contact = \"resolved\""),
            std::string::npos);
}

TEST_F(DriverAccuracyTest, AdviceRefusesWhatNothingReaches) {
  EXPECT_EQ(run(impact + "--error 1e-30", "advise"), 2);
  EXPECT_NE(err().find("nothing reaches it; the smallest error of height"), std::string::npos);
  EXPECT_EQ(run(impact + "--error -1", "advise"), 2);
  EXPECT_NE(err().find("--error -1: allowed is a number above 0"), std::string::npos) << err();
  EXPECT_EQ(run(impact + "--error 1 --observable colour", "advise"), 2);
  EXPECT_NE(err().find("--observable colour: unknown"), std::string::npos) << err();
  EXPECT_EQ(run("example-7 --set output.frames_at=[0.0] --set time.end=0.02 --error 1 "
                "--observable position",
                "advise"),
            2);
  EXPECT_NE(err().find("--observable position: allowed is another"), std::string::npos) << err();
  EXPECT_EQ(run(impact + "--error 1 --kernel ring --out there", "run"), 2);
  EXPECT_NE(err().find("--kernel"), std::string::npos) << err();
  EXPECT_EQ(run(impact + "--error 1e-30 --out there", "run"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "there"));
}

}  // namespace
}  // namespace bounce
