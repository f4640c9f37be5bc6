// Where output goes: what stands at its path, who else writes there, and what a full disk, a closed
// pipe or a signal makes of it.
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

// A small ball that is quick whatever is done with it.
constexpr const char* ball =
    "[ball]\nradii = [1.0, 2.0]\nper_ring = 12\ncentre = [0.0, 3.0]\n"
    "[law]\nelasticity = 1000.0\nrest = \"geometry\"\n"
    "[gravity]\nacceleration = [0.0, -98.0]\n[[wall]]\n"
    "[time]\nstep = 1e-3\nend = 0.2\n[output]\nmonitor_every = 0.05\n";

class DriverOutputTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "ball.toml") << ball;
    std::ofstream(folder_ / "paper.toml") << "[time]\nend = 1e-4\n[output]\nmonitor_every = 1e-4\n";
  }
  // A stand-in for /dev/null or /dev/full in the test's folder; false if none can be made there.
  [[nodiscard]] bool make_node(const char* name, unsigned minor) const {
    const fs::path path = folder_ / name;
    if (mknod(path.c_str(), S_IFCHR | 0600, makedev(1, minor)) != 0) return false;
    const int opened = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    close(opened);
    return opened >= 0;
  }
  // A run that ends when it is told to.
  pid_t start_endless(const std::string& out) {
    const pid_t child = start({"run", "ball.toml", "--t-end", "300000", "-q", "--out", out});
    wait_for(out + ".part/checkpoint");
    return child;
  }
  static bool runs(pid_t child) { return waitpid(child, nullptr, WNOHANG) == 0; }
};

TEST_F(DriverOutputTest, DevicesStayAndAreWrittenInto) {
  if (!make_node("node", 3)) GTEST_SKIP() << "no device can be made here";
  EXPECT_EQ(run({"verify", "paper.toml", "--quick", "--out", "node"}), 0) << err();
  EXPECT_TRUE(fs::is_character_file(folder_ / "node"));
  EXPECT_EQ(run({"run", "ball.toml", "--final-state", "node", "--force", "--out", "r"}), 0)
      << err();
  EXPECT_TRUE(fs::is_character_file(folder_ / "node"));
  EXPECT_EQ(names(), (Words{"ball.toml", "node", "paper.toml", "r"}));
  // A disk would be written over from its first byte on; it is never opened.
  ASSERT_EQ(mknod((folder_ / "disk").c_str(), S_IFBLK | 0600, makedev(240, 0)), 0);
  EXPECT_EQ(run({"verify", "--full", "--out", "disk"}), 2);
  EXPECT_NE(err().find("disk: is a disk; allowed is a file's name"), std::string::npos) << err();
}

TEST_F(DriverOutputTest, PipesAndStandardOutputAreWrittenInto) {
  EXPECT_EQ(shell("mkfifo pipe; cat pipe > got & \"$BOUNCE\" run ball.toml --out r -q "
                  "--final-state pipe; code=$?; wait; exit $code"),
            0)
      << err();
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
  EXPECT_EQ(contents(folder_ / "got"), contents(folder_ / "r/final.csv"));
  ASSERT_EQ(shell("\"$BOUNCE\" run ball.toml --out s -q --final-state /dev/stdout"), 0) << err();
  EXPECT_EQ(out(), contents(folder_ / "s/final.csv"));
  ASSERT_EQ(shell("\"$BOUNCE\" run ball.toml --out t -q --final-state /dev/stdout | cat"), 0)
      << err();
  EXPECT_EQ(out(), contents(folder_ / "s/final.csv"));
}

TEST_F(DriverOutputTest, LinksStayAndTheirTargetsAreWritten) {
  fs::create_directory(folder_ / "there");
  std::ofstream(folder_ / "there/old") << "old\n";
  chmod((folder_ / "there/old").c_str(), 0640);
  fs::create_symlink("there/old", folder_ / "link");
  fs::create_symlink("there/new", folder_ / "dangling");
  for (const std::string name : {"link", "dangling"}) {
    EXPECT_EQ(run({"run", "ball.toml", "--final-state", name, "--force", "--out", "r"}), 0)
        << err();
    EXPECT_TRUE(fs::is_symlink(folder_ / name));
    EXPECT_EQ(contents(folder_ / name), contents(folder_ / "r/final.csv"));
  }
  EXPECT_EQ(names("there"), (Words{"new", "old"}));
  struct stat old {};
  ASSERT_EQ(stat((folder_ / "there/old").c_str(), &old), 0);
  EXPECT_EQ(old.st_mode & 0777, 0640U);
  EXPECT_EQ(run({"run", "ball.toml", "--final-state", "link", "--out", "s"}), 2);
  EXPECT_NE(err().find("--force overwrites it"), std::string::npos) << err();
  // A link in a directory's place is neither replaced nor followed.
  fs::create_symlink("r", folder_ / "place");
  EXPECT_EQ(run({"run", "ball.toml", "--out", "place", "--force"}), 2);
  EXPECT_NE(err().find("is a link"), std::string::npos) << err();
  EXPECT_TRUE(fs::is_symlink(folder_ / "place"));
}

TEST_F(DriverOutputTest, AllPathsAreCheckedBeforeTheWork) {
  fs::create_directories(folder_ / "folder/extremes.md");
  ASSERT_EQ(shell("mkfifo pipe"), 0);
  const Words before = names();
  struct Case {
    Words words;
    const char* message;
  };
  const auto begin = std::chrono::steady_clock::now();
  for (const Case& c : std::vector<Case>{
           {{"verify", "--full", "--out", "no/t.txt"}, "no is not a folder that can be written to"},
           {{"verify", "--full", "--out", "folder"}, "is a directory"},
           {{"verify", "--full", "--out", "ball.toml/t"}, "Not a directory"},
           {{"extremes", "--out", "ball.toml/t"}, "cannot be made there: Not a directory"},
           {{"extremes", "--out", "folder"}, "extremes.md: is a directory"},
           {{"extremes", "--runs", "no/runs"}, "cannot be made there: No such file"},
           {{"run", "large-ball", "--final-state", "no/f.csv"}, "is not a folder"},
           {{"run", "large-ball", "--final-state", "folder"}, "is a directory"},
           {{"run", "large-ball", "--final-state", "o/", "--out", "o"}, "is where the results go"},
           {{"run", "example-2", "--error", "1e-3", "--out", "ball.toml/o"}, "Not a directory"},
           {{"run", "example-2", "--out", "pipe", "--force"}, "it is no directory"},
           {{"run", "example-2", "--out", "pipe"}, "exists already and is not"},
           {{"accuracy", "example-2", "--out", "ball.toml/o"}, "Not a directory"},
           {{"reference", "example-2", "--out", "ball.toml/o"}, "Not a directory"},
           {{"stability", "example-2", "--out", "ball.toml/o"}, "Not a directory"},
           {{"stability", "example-2", "--out", "folder", "--force"}, "no edge.csv there"},
       }) {
    EXPECT_EQ(run(c.words), 2) << c.message;
    EXPECT_NE(err().find(c.message), std::string::npos) << c.message << " not in: " << err();
    EXPECT_EQ(lines(err()), 1) << err();
    EXPECT_EQ(names(), before) << c.message;
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

TEST_F(DriverOutputTest, TemporaryNamesAreNew) {
  EXPECT_EQ(shell("mkdir o.part; echo alien > o.part/ledger.csv\n"
                  "exec \"$BOUNCE\" run ball.toml --out o -q --force"),
            2);
  EXPECT_NE(err().find("o.part is there, and is no stopped run"), std::string::npos) << err();
  EXPECT_EQ(contents(folder_ / "o.part/ledger.csv"), "alien\n");
  EXPECT_FALSE(fs::exists(folder_ / "o"));
  EXPECT_EQ(shell("echo mine > f.partial-$$; ln f.partial-$$ kept\n"
                  "exec \"$BOUNCE\" run ball.toml --out p -q --final-state f"),
            0)
      << err();
  EXPECT_EQ(contents(folder_ / "kept"), "mine\n");
  EXPECT_EQ(contents(folder_ / "f"), contents(folder_ / "p/final.csv"));
}

TEST_F(DriverOutputTest, ASecondRunForADirectoryIsRefusedWhileTheFirstIsAtIt) {
  const pid_t first = start_endless("r");
  for (const Words& second : std::vector<Words>{{"run", "ball.toml", "--out", "r"},
                                                {"run", "ball.toml", "--out", "./r/", "--force"},
                                                {"stability", "ball.toml", "--quick", "--out", "r"},
                                                {"reference", "ball.toml", "--out", "r"}}) {
    EXPECT_EQ(run(second), 2) << second[0];
    EXPECT_NE(err().find("--out"), std::string::npos) << err();
    EXPECT_NE(err().find("another bounce is at work"), std::string::npos) << err();
  }
  kill(first, SIGKILL);
  EXPECT_EQ(finish(first), 1000 + SIGKILL);
  // A crash leaves no lock, but a run that can be gone on with.
  EXPECT_EQ(run({"run", "ball.toml", "--out", "r", "-q"}), 2);
  EXPECT_NE(err().find("\"bounce resume r\" goes on with it"), std::string::npos) << err();
  EXPECT_EQ(run({"run", "ball.toml", "--out", "r", "-q", "--force"}), 0) << err();
  EXPECT_EQ(entry(folder_ / "r/run.json", "status"), "\"complete\"");
  for (const std::string& name : names()) EXPECT_EQ(name.find("lock"), std::string::npos) << name;
}

TEST_F(DriverOutputTest, SignalsEndARunAsCtrlCDoes) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    std::string name("r");
    name += std::to_string(signal);
    const pid_t child = start_endless(name);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    kill(child, signal);
    EXPECT_EQ(finish(child), 128 + signal) << err();
    EXPECT_NE(err().find("last state in " + name + "/final.csv"), std::string::npos) << err();
    EXPECT_EQ(entry(folder_ / name / "run.json", "status"), "\"interrupted\"");
    EXPECT_EQ(lines(contents(folder_ / name / "final.csv")), 25);
  }
  EXPECT_EQ(names(), (Words{"ball.toml", "paper.toml", "r1", "r15", "r2"}));
}

TEST_F(DriverOutputTest, SignalsThatTheParentIgnoresStayIgnored) {
  ignored_ = {SIGINT, SIGHUP};
  const pid_t child = start_endless("r");
  for (const int signal : {SIGINT, SIGHUP, SIGINT}) {
    kill(child, signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ASSERT_TRUE(runs(child)) << signal << err();
  }
  kill(child, SIGTERM);
  EXPECT_EQ(finish(child), 128 + SIGTERM) << err();
}

TEST_F(DriverOutputTest, SignalsEndTheRowsOfExtremesToo) {
  std::ofstream(folder_ / "long.toml")
      << "[extreme]\ngroup = \"edge\"\nexpect = \"complete\"\nbecause = \"so\"\n"
      << "[time]\nend = 100000\n[output]\nmonitor_every = 0.01\n";
  const pid_t child = start({"extremes", "--only", "long.toml", "--runs", "runs"});
  wait_for("runs");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  kill(child, SIGTERM);
  EXPECT_EQ(finish(child), 128 + SIGTERM) << err();
  EXPECT_EQ(entry(folder_ / "runs/long/run.json", "status"), "\"interrupted\"");
}

// Every command that prints, each with an output that is short of nothing else.
const std::vector<Words> printing{
    {"list"},
    {"show", "example-2"},
    {"--help"},
    {"run", "--help"},
    {"--version"},
    {"stability", "ball.toml", "--predict"},
    {"stability", "ball.toml", "--predict", "--json"},
    {"stability", "ball.toml", "--e", "1000", "--flight-only", "--no-disturbed", "--methods",
     "leapfrog", "--periods", "20", "--force"},
    {"run", "ball.toml", "--force"},
    {"verify", "paper.toml", "--quick"},
    {"reference", "ball.toml", "--t-end", "0.02", "--force"},
    {"advise", "ball.toml", "--error", "1e-2"},
    {"extremes", "--list"},
    {"extremes", "--only", "edge-below-leapfrog"},
};

TEST_F(DriverOutputTest, WhatCannotBePrintedIsAnErrorOfEveryCommand) {
  const bool has_full = make_node("full", 7);
  const auto run_into = [this](int descriptor, const Words& words) {
    stdout_ = descriptor;
    const int code = run(words);
    close(std::exchange(stdout_, -1));
    return code;
  };
  const std::string message =
      "bounce: standard output cannot be written: No space left on device\n";
  for (const Words& words : printing) {
    ASSERT_EQ(run(words), 0) << words[0] << err();
    const auto usual = lines(err());
    // A reader that has gone is no fault: quietly.
    int ends[2];
    ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
    close(ends[0]);
    EXPECT_EQ(run_into(ends[1], words), 128 + SIGPIPE) << words[0] << " " << words.back();
    EXPECT_EQ(lines(err()), usual) << words[0] << err();
    if (!has_full) continue;
    EXPECT_EQ(run_into(open((folder_ / "full").c_str(), O_WRONLY | O_CLOEXEC), words), 1)
        << words[0] << " " << words.back();
    EXPECT_EQ(count(err(), message), 1) << words[0] << err();
    EXPECT_EQ(lines(err()), usual + 1) << err();
  }
  // What is written to files is there all the same.
  EXPECT_EQ(entry(folder_ / "runs/ball/run.json", "status"), "\"complete\"");
  EXPECT_EQ(names("runs"), (Words{"ball", "ball-reference", "ball-stability"}));
  EXPECT_EQ(shell("\"$BOUNCE\" list >&-"), 1);
  EXPECT_NE(err().find("standard output cannot be written: Bad file descriptor"), std::string::npos)
      << err();
  if (!has_full) GTEST_SKIP() << "no device can be made here";
}

// No device needed: a disk that is full after the first bytes.
TEST_F(DriverOutputTest, AFileThatIsFullIsAnErrorToo) {
  largest_file_ = 100;
  for (const Words& words : {Words{"list"}, Words{"show", "example-2"}, Words{"--help"}}) {
    EXPECT_EQ(run(words), 1) << words[0];
    EXPECT_NE(err().find("standard output cannot be written: File too large"), std::string::npos)
        << err();
  }
}

// A file that is opened must not get the number of a stream that is closed.
TEST_F(DriverOutputTest, WhatIsPrintedNeverEndsInAFile) {
  EXPECT_EQ(shell("\"$BOUNCE\" run ball.toml --out r >&- 2>&- <&-"), 1);
  EXPECT_EQ(shell("\"$BOUNCE\" run ball.toml --out s"), 0) << err();
  for (const char* name : {"monitor.csv", "final.csv", "frames.extxyz", "scene.toml"}) {
    EXPECT_EQ(contents(folder_ / "r" / name), contents(folder_ / "s" / name)) << name;
  }
}

}  // namespace
}  // namespace bounce
