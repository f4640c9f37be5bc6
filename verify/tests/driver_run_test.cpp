// The program itself, run as a user runs it. BOUNCE_PROGRAM is its path.
#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// The text of a top-level entry of run.json, quotes and all.
std::string entry(const fs::path& json, const std::string& key) {
  const std::string text = contents(json);
  const std::string start = "\n  \"" + key + "\": ";
  const auto at = text.find(start);
  if (at == std::string::npos) return "";
  const auto from = at + start.size();
  return text.substr(from, text.find_first_of(",\n", from) - from);
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

class DriverRunTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Starts the program in the test's folder, its output in the files stdout and stderr.
  pid_t start(Words words) {
    words.insert(words.begin(), BOUNCE_PROGRAM);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      const int flags = O_WRONLY | O_CREAT | O_TRUNC;
      if (chdir(folder_.c_str()) != 0) _exit(99);
      if (largest_file_ > 0) {
        const rlimit limit{largest_file_, largest_file_};
        signal(SIGXFSZ, SIG_IGN);  // so that writing fails, as on a full disk
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
      }
      if (memory_ > 0) {
        const rlimit limit{memory_, memory_};
        if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(99);
      }
      dup2(open("stdout", flags, 0600), STDOUT_FILENO);
      dup2(open("stderr", flags, 0600), STDERR_FILENO);
      execv(BOUNCE_PROGRAM, arguments.data());
      _exit(99);
    }
    return child;
  }
  // The exit code; 1000 + signal if it was killed, by us if it takes more than a minute.
  static int finish(pid_t child) {
    int status = 0;
    for (int wait = 0; waitpid(child, &status, WNOHANG) == 0; ++wait) {
      if (wait == 12000) kill(child, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  int run(const Words& words) { return finish(start(words)); }

  [[nodiscard]] std::string out() const { return contents(folder_ / "stdout"); }
  [[nodiscard]] std::string err() const { return contents(folder_ / "stderr"); }
  // Names in a folder, sorted, without the captured output.
  [[nodiscard]] Words names(const fs::path& below = ".") const {
    Words found;
    for (const auto& item : fs::directory_iterator(folder_ / below)) {
      const std::string name = item.path().filename();
      if (name != "stdout" && name != "stderr") found.push_back(name);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  fs::path folder_;
  rlim_t largest_file_ = 0;  // bytes the program may write to a file; 0: no limit
  rlim_t memory_ = 0;        // bytes it may take; 0: no limit
};

TEST_F(DriverRunTest, ARunWritesItsDirectory) {
  ASSERT_EQ(run({"run", "example-2", "--steps", "20000", "--set", "output.frames_every=0.01"}), 0)
      << err();
  EXPECT_EQ(err(), "");  // no progress where there is no terminal
  EXPECT_EQ(names(), Words{"runs"});
  EXPECT_EQ(names("runs"), Words{"example-2"});
  EXPECT_EQ(names("runs/example-2"),
            (Words{"final.csv", "frames.extxyz", "monitor.csv", "run.json", "scene.toml"}));
  const fs::path at = folder_ / "runs/example-2";
  EXPECT_EQ(entry(at / "run.json", "status"), "\"complete\"");
  EXPECT_EQ(entry(at / "run.json", "steps"), "20000");
  EXPECT_EQ(entry(at / "run.json", "precision"), "\"double\"");
  EXPECT_EQ(entry(at / "run.json", "bonds"), "840");
  const std::string hash = entry(at / "run.json", "state_hash");
  EXPECT_EQ(hash.size(), 18U);
  EXPECT_NE(out().find("state hash: " + hash.substr(1, 16)), std::string::npos) << out();
  EXPECT_NE(out().find("plan: kernel "), std::string::npos) << out();
  EXPECT_EQ(contents(at / "monitor.csv").substr(0, 31), "t,kinetic,bond,gravity,total,px");
  EXPECT_EQ(lines(contents(at / "monitor.csv")), 4U);  // header, 0, 0.01, 0.02
  EXPECT_EQ(lines(contents(at / "frames.extxyz")), 3U * 362U);
  EXPECT_EQ(contents(at / "frames.extxyz").substr(0, 4), "360\n");
  EXPECT_EQ(lines(contents(at / "final.csv")), 361U);
  // The resolved scene runs again, to the same bits.
  ASSERT_EQ(run({"run", "runs/example-2/scene.toml", "--out", "again", "--quiet"}), 0) << err();
  EXPECT_EQ(out(), "");
  EXPECT_EQ(entry(folder_ / "again/run.json", "state_hash"), hash);
}

// The ball of Example 2 just above the axis, at the speed it has there after its fall.
Words to_the_wall(const Words& more) {
  Words words{"run",     "example-2",
              "--set",   "ball.centre=[0, 7.002]",
              "--set",   "ball.velocity=[0, -0.7668]",
              "--set",   "output.monitor_every=0.001",
              "--steps", "12000"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(DriverRunTest, ARunTellsItsBounceAndItsLedgers) {
  ASSERT_EQ(run(to_the_wall({"--out", "r"})), 0) << err();
  for (const char* word : {"energy: ", " lost to the walls (from samples)", "bounce: contact from ",
                           "greatest flattening 0.", "ledgers close on the ", "momentum y"}) {
    EXPECT_NE(out().find(word), std::string::npos) << word << " not in: " << out();
  }
  const std::string json = contents(folder_ / "r/run.json");
  for (const char* word : {"\"form\": \"samples\"", "\"closes\": true", "\"first_contact\": 0.00",
                           "\"restitution\": null", "\"greatest_flattening\": "}) {
    EXPECT_NE(json.find(word), std::string::npos) << word << " not in: " << json;
  }
  const std::string monitor = contents(folder_ / "r/monitor.csv");
  EXPECT_NE(monitor.find(",on_wall,walls,drift,impulse_x,impulse_y,stable_part\n"),
            std::string::npos);
}

TEST_F(DriverRunTest, BookingEveryReflectionChangesNoBit) {
  for (const std::string kernel : {"auto", "ring", "oracle"}) {
    ASSERT_EQ(run(to_the_wall({"--kernel", kernel, "--force", "--out", "r"})), 0) << err();
    ASSERT_EQ(run(to_the_wall({"--kernel", kernel, "--ledger", "--force", "--out", "s"})), 0)
        << err();
    EXPECT_NE(out().find("ledgers close, every reflection booked"), std::string::npos) << out();
    EXPECT_EQ(contents(folder_ / "r/final.csv"), contents(folder_ / "s/final.csv")) << kernel;
    EXPECT_EQ(lines(contents(folder_ / "s/ledger.csv")), 13U);  // header, one a millisecond
    const std::string json = contents(folder_ / "s/run.json");
    EXPECT_NE(json.find("\"form\": \"full\""), std::string::npos) << json;
    EXPECT_EQ(json.find("\"reflections\": 0,"), std::string::npos) << json;
  }
}

TEST_F(DriverRunTest, LocatedContactRunsAndHasNoBooks) {
  const Words located{"--set", "wall.contact=located", "--set", "time.method=leapfrog"};
  Words words = to_the_wall({"--out", "r"});
  words.insert(words.end(), located.begin(), located.end());
  ASSERT_EQ(run(words), 0) << err();
  EXPECT_NE(out().find("contact located"), std::string::npos) << out();
  EXPECT_NE(out().find("ledgers close on the "), std::string::npos) << out();
  words = to_the_wall({"--ledger", "--out", "s"});
  words.insert(words.end(), located.begin(), located.end());
  EXPECT_EQ(run(words), 2);
  EXPECT_NE(err().find("--ledger: allowed is wall.contact listing or resolved"), std::string::npos)
      << err();
  EXPECT_FALSE(fs::exists(folder_ / "s"));
}

TEST_F(DriverRunTest, AnUnstableRunWithBooksEndsAsWithout) {
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

// The number behind a key of a JSON text; NaN if there is none.
double number(const std::string& json, const std::string& key) {
  const auto at = json.find("\"" + key + "\": ");
  if (at == std::string::npos) return std::nan("");
  char* end = nullptr;
  const char* text = json.c_str() + at + key.size() + 4;
  const double value = std::strtod(text, &end);
  return end == text ? std::nan("") : value;
}

TEST_F(DriverRunTest, RecordsThePrecision) {
  ASSERT_EQ(
      run({"run", "example-2", "--steps", "1000", "--set", "time.precision=single", "--out", "r"}),
      0)
      << err();
  EXPECT_EQ(entry(folder_ / "r/run.json", "precision"), "\"single\"");
  EXPECT_NE(contents(folder_ / "r/run.json").find("\"kernel\": \"ring\""), std::string::npos);
}

// The oracle knows one, and what is allowed is told by its roundings.
TEST_F(DriverRunTest, VerifyRefusesOtherPrecisions) {
  for (const std::string precision : {"compensated", "single"}) {
    std::ofstream(folder_ / "mine.toml") << "[time]\nprecision = \"" << precision << "\"\n";
    EXPECT_EQ(run({"verify", "mine.toml", "--quick"}), 2);
    EXPECT_NE(err().find("time.precision = " + precision + ": allowed is double"),
              std::string::npos)
        << err();
  }
}

TEST_F(DriverRunTest, ADiscFallsAndBounces) {
  ASSERT_EQ(run({"run", "disc", "--set", "ball.spacing=0.5", "--set", "law.elasticity=5000",
                 "--out", "r"}),
            0)
      << err();
  const std::string json = contents(folder_ / "r/run.json");
  EXPECT_NE(json.find("\"kernel\": \"csr\""), std::string::npos) << json;
  EXPECT_EQ(number(json, "particles"), 517.0);
  // The lowest row hangs 13 rows, 5.63 cm, below the centre.
  const double fall = 10.0 - 13 * 0.5 * std::sqrt(0.75);
  EXPECT_NEAR(number(json, "first_contact"), std::sqrt(2.0 * fall / 9.8), 0.011);
  EXPECT_GT(number(json, "greatest_flattening"), 0.02);
  const double lowest = number(json, "lowest_centre"), back = number(json, "rebound_height");
  EXPECT_TRUE(lowest > 4.0 && lowest < 5.6) << lowest;
  EXPECT_GT(back, lowest + 0.5);
  // One ring, so to speak, in every frame.
  std::ifstream frames(folder_ / "r/frames.extxyz");
  std::string line;
  std::getline(frames, line);
  EXPECT_EQ(line, "517");
  std::getline(frames, line);
  for (int i = 0; i < 517; ++i) {
    std::getline(frames, line);
    EXPECT_EQ(line.substr(line.rfind(' ')), " 1");
  }
}

TEST_F(DriverRunTest, AThickAnnulusIsSteppedByRings) {
  ASSERT_EQ(
      run({"run", "annulus", "--steps", "20", "--set", "ball.centre=[0, 21.0785]", "--out", "r"}),
      0)
      << err();
  const std::string json = contents(folder_ / "r/run.json");
  EXPECT_NE(json.find("\"kernel\": \"rings\""), std::string::npos) << json;
  EXPECT_EQ(number(json, "particles"), 72000.0);
}

TEST_F(DriverRunTest, ABallThatMemoryCannotHoldIsRefusedBeforeItIsBuilt) {
  const Words words{"run",   "large-ball",        "--steps", "1", "--set", "ball.per_ring=3000000",
                    "--set", "ball.rounding=none"};
  memory_ = rlim_t{1} << 30;
  ASSERT_EQ(run(words), 2) << err();
  EXPECT_NE(err().find("--set: ball.per_ring = 3000000: allowed is a ball of at most "),
            std::string::npos)
      << err();
  EXPECT_TRUE(names().empty());
}

TEST_F(DriverRunTest, BadInputExitsWith2AndLeavesNothing) {
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
           {{"fly"}, "subcommand is required"},
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

TEST_F(DriverRunTest, NothingIsOverwrittenWithoutForce) {
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

TEST_F(DriverRunTest, AFullDiskIsAnErrorThatLeavesNothing) {
  largest_file_ = 4096;  // scene.toml fits, a frame does not
  EXPECT_EQ(run({"run", "example-2", "--steps", "10"}), 1);
  EXPECT_NE(err().find("frames.extxyz: cannot be written: "), std::string::npos) << err();
  EXPECT_EQ(names("runs"), Words{});
}

TEST_F(DriverRunTest, AFinalStateContinuesToTheBit) {
  ASSERT_EQ(run({"run", "example-5", "--steps", "3000", "--final-state", "a.csv"}), 0) << err();
  ASSERT_EQ(run({"run", "example-5", "--steps", "2000", "--initial", "a.csv", "--out", "b"}), 0)
      << err();
  ASSERT_EQ(run({"run", "example-5", "--steps", "5000", "--out", "c"}), 0) << err();
  const std::string hash = entry(folder_ / "b/run.json", "state_hash");
  EXPECT_EQ(hash.size(), 18U);
  EXPECT_EQ(hash, entry(folder_ / "c/run.json", "state_hash"));
  EXPECT_NE(hash, entry(folder_ / "runs/example-5/run.json", "state_hash"));
}

TEST_F(DriverRunTest, TheListingsFramesCanBeReadBack) {
  ASSERT_EQ(run({"run", "example-2", "--steps", "1", "--listing-frames", "--out", "r"}), 0)
      << err();
  EXPECT_EQ(names("r"), (Words{"BAL4.OUT", "final.csv", "frames.extxyz", "monitor.csv", "run.json",
                               "scene.toml"}));
  EXPECT_EQ(lines(contents(folder_ / "r/BAL4.OUT")), 360U);
  // Read as a start, it is the first frame, number for number.
  ASSERT_EQ(run({"run", "example-2", "--steps", "1", "--initial", "r/BAL4.OUT", "--out", "s"}), 0)
      << err();
  std::ifstream listing(folder_ / "r/BAL4.OUT");
  std::ifstream frame(folder_ / "s/frames.extxyz");
  std::string word;
  std::getline(frame, word);
  std::getline(frame, word);
  for (int i = 0; i < 360; ++i) {
    double x = 0, y = 0, vx = 0, vy = 0;
    double frame_x = -1, frame_y = -1, frame_vx = -1, frame_vy = -1, zero = -1;
    listing >> x >> y >> vx >> vy;
    frame >> word >> frame_x >> frame_y >> zero >> frame_vx >> frame_vy >> zero >> word;
    ASSERT_TRUE(listing && frame) << i;
    EXPECT_TRUE(x == frame_x && y == frame_y && vx == frame_vx && vy == frame_vy) << i;
    EXPECT_EQ(zero, 0.0);
  }
}

TEST_F(DriverRunTest, ListingFramesComeEachMillionSteps) {
  // Small steps need not be real ones: a ball of one ring of three is as good, and quick.
  ASSERT_EQ(
      run({"run", "example-2", "--steps", "2000001", "--listing-frames", "--out", "r", "--set",
           "ball.radii=[1]", "--set", "ball.per_ring=3", "--set", "law.rest=geometry"}),
      0)
      << err();
  const Words files = names("r");
  EXPECT_EQ(Words(files.begin(), files.begin() + 3), (Words{"BAL4.OUT", "BAL4.OUT1", "BAL4.OUT2"}));
  EXPECT_EQ(files[3], "final.csv");
}

TEST_F(DriverRunTest, AnUnstableRunExitsWith3AndKeepsTheLastGoodState) {
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

// The number after `"key": ` behind the first `"object": {` of a JSON text, as it stands there.
std::string number_in(const std::string& text, const std::string& object, const std::string& key) {
  const auto from = text.find("\"" + key + "\": ", text.find("\"" + object + "\": {"));
  if (from == std::string::npos) return "";
  const auto at = from + key.size() + 4;
  return text.substr(at, text.find_first_of(",\n", at) - at);
}

TEST_F(DriverRunTest, AStoppedRunGoesOnFromItsLastGoodStateAsItIsTold) {
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

// Example 2 at its start: omega_max = 5221 1/s, stable step 3.83e-4 s.
TEST_F(DriverRunTest, AStepBeyondTheEdgeIsRefusedAndOneNearItWarnedOf) {
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
TEST_F(DriverRunTest, MotionThatRoundingLosesIsWarnedOf) {
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

// A step so short that the scene's own end would be too many of them.
TEST_F(DriverRunTest, StepsReplaceAnEndThatIsTooFar) {
  const Words words{"run",   "example-2", "--set", "time.step=1e-20",           "--quiet",
                    "--out", "r",         "--set", "output.monitor_every=1e-19"};
  EXPECT_EQ(run(words), 2);
  EXPECT_NE(err().find("at most 1e15 steps"), std::string::npos) << err();
  Words few = words;
  few.insert(few.end(), {"--steps", "20"});
  EXPECT_EQ(run(few), 0) << err();
  EXPECT_EQ(entry(folder_ / "r/run.json", "steps"), "20");
}

TEST_F(DriverRunTest, ARunTellsItsPartOfTheStableStep) {
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

TEST_F(DriverRunTest, StabilityIsPredicted) {
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

TEST_F(DriverRunTest, CtrlCKeepsWhatIsWritten) {
  const pid_t child = start({"run", "example-2", "--t-end", "100000", "--out", "r"});
  // Wait until it has something to keep: monitor.csv in the partial directory.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  const fs::path partial = folder_ / ("r.partial-" + std::to_string(child));
  while (!fs::exists(partial / "frames.extxyz") && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  kill(child, SIGINT);
  EXPECT_EQ(finish(child), 130) << err();
  EXPECT_NE(err().find("interrupted at step "), std::string::npos) << err();
  EXPECT_EQ(names(), Words{"r"});
  EXPECT_EQ(entry(folder_ / "r/run.json", "status"), "\"interrupted\"");
  EXPECT_GT(std::stol(entry(folder_ / "r/run.json", "steps")), 0);
  EXPECT_EQ(lines(contents(folder_ / "r/final.csv")), 361U);
}

TEST_F(DriverRunTest, SetChangesWhatRuns) {
  ASSERT_EQ(run({"run", "example-7", "--steps", "10", "--set", "wall.alpha=0.25", "--out", "r"}), 0)
      << err();
  const std::string scene = contents(folder_ / "r/scene.toml");
  std::size_t found = 0;
  for (auto at = scene.find("alpha = 0.25"); at != std::string::npos;
       at = scene.find("alpha = 0.25", at + 1)) {
    ++found;
  }
  EXPECT_EQ(found, 2U) << scene;
}

TEST_F(DriverRunTest, TheOtherCommandsTell) {
  EXPECT_EQ(run({"list"}), 0);
  for (const char* word :
       {"example-7", "law-2-4", "large-ball", "listing", "oracle", "wall.alpha"}) {
    EXPECT_NE(out().find(word), std::string::npos) << word;
  }
  EXPECT_EQ(run({"show", "example-3"}), 0);
  EXPECT_NE(out().find("elasticity = 1000.0"), std::string::npos);
  EXPECT_EQ(run({"--version"}), 0);
  EXPECT_NE(out().find("commit "), std::string::npos);
  EXPECT_NE(out().find("vector targets: "), std::string::npos);
  EXPECT_EQ(run({"run", "--help"}), 0);
  EXPECT_NE(out().find("Examples:"), std::string::npos);
}

}  // namespace
