// What bounce run makes of a scene.
#include <omp.h>
#include <sched.h>

#include "driver/scene/state_file.hpp"
#include "verify/tests/driver/program_test.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

class DriverRunTest : public ProgramTest {
 protected:
  // The last state of a run's directory.
  [[nodiscard]] State state_in(const fs::path& directory) const {
    return read_state((folder_ / directory / "final.csv").string()).state;
  }
};

TEST_F(DriverRunTest, ARunWritesItsDirectory) {
  ASSERT_EQ(run({"run", "example-2", "--steps", "20000", "--set", "output.frames_every=0.01"}), 0)
      << err();
  EXPECT_EQ(err(), "");  // no progress where there is no terminal
  EXPECT_EQ(names(), Words{"runs"});
  EXPECT_EQ(names("runs"), Words{"example-2"});
  EXPECT_EQ(names("runs/example-2"), (Words{"checkpoint", "final.csv", "frames.extxyz",
                                            "monitor.csv", "run.json", "scene.toml"}));
  const fs::path at = folder_ / "runs/example-2";
  EXPECT_EQ(entry(at / "run.json", "status"), "\"complete\"");
  EXPECT_EQ(entry(at / "run.json", "steps"), "20000");
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
  EXPECT_TRUE(same_state(state_in("again"), state_in("runs/example-2")));
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
                           "greatest flattening ", "ledgers close on the ", "momentum y"}) {
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

TEST_F(DriverRunTest, ADiscFallsAndBounces) {
  ASSERT_EQ(run({"run", "disc", "--set", "ball.spacing=0.5", "--set", "law.elasticity=5000",
                 "--out", "r"}),
            0)
      << err();
  const std::string json = contents(folder_ / "r/run.json");
  EXPECT_NE(json.find("\"kernel\": \"csr\""), std::string::npos) << json;
  EXPECT_EQ(number_after(json, "\"particles\": "), 517.0);
  // The lowest row hangs 13 rows, 5.63 cm, below the centre.
  const double fall = 10.0 - 13 * 0.5 * std::sqrt(0.75);
  EXPECT_NEAR(number_after(json, "\"first_contact\": "), std::sqrt(2.0 * fall / 9.8), 0.011);
  EXPECT_GT(number_after(json, "\"greatest_flattening\": "), 0.02);
  const double lowest = number_after(json, "\"lowest_centre\": "),
               back = number_after(json, "\"rebound_height\": ");
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

TEST_F(DriverRunTest, AThickAnnulusIsSteppedByAnnulus) {
  ASSERT_EQ(
      run({"run", "annulus", "--steps", "20", "--set", "ball.centre=[0, 21.0785]", "--out", "r"}),
      0)
      << err();
  const std::string json = contents(folder_ / "r/run.json");
  EXPECT_NE(json.find("\"kernel\": \"annulus\""), std::string::npos) << json;
  EXPECT_EQ(number_after(json, "\"particles\": "), 72000.0);
}

TEST_F(DriverRunTest, AFinalStateContinuesToTheBit) {
  ASSERT_EQ(run({"run", "example-5", "--steps", "3000", "--final-state", "a.csv"}), 0) << err();
  ASSERT_EQ(run({"run", "example-5", "--steps", "2000", "--initial", "a.csv", "--out", "b"}), 0)
      << err();
  ASSERT_EQ(run({"run", "example-5", "--steps", "5000", "--out", "c"}), 0) << err();
  const std::string hash = entry(folder_ / "b/run.json", "state_hash");
  EXPECT_EQ(hash.size(), 18U);
  EXPECT_TRUE(same_state(state_in("b"), state_in("c")));
  EXPECT_EQ(hash, entry(folder_ / "c/run.json", "state_hash"));
  EXPECT_NE(hash, entry(folder_ / "runs/example-5/run.json", "state_hash"));
}

TEST_F(DriverRunTest, TheListingsFramesCanBeReadBack) {
  ASSERT_EQ(run({"run", "example-2", "--steps", "1", "--listing-frames", "--out", "r"}), 0)
      << err();
  EXPECT_EQ(names("r"), (Words{"BAL4.OUT", "checkpoint", "final.csv", "frames.extxyz",
                               "monitor.csv", "run.json", "scene.toml"}));
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
  EXPECT_EQ(files[3], "checkpoint");
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

TEST_F(DriverRunTest, CtrlCKeepsWhatIsWritten) {
  // No row is due before 1000 s: the last one is there because it was stopped.
  const pid_t child = start({"run", "example-2", "--t-end", "100000", "--out", "r", "--set",
                             "output.monitor_every=1000"});
  wait_for("r.part");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  kill(child, SIGINT);
  EXPECT_EQ(finish(child), 130) << err();
  EXPECT_NE(err().find("interrupted at step "), std::string::npos) << err();
  EXPECT_EQ(names(), Words{"r"});
  EXPECT_EQ(entry(folder_ / "r/run.json", "status"), "\"interrupted\"");
  EXPECT_GT(std::stol(entry(folder_ / "r/run.json", "steps")), 0);
  EXPECT_EQ(lines(contents(folder_ / "r/final.csv")), 361U);
  // The last row of the monitor is of the last state.
  const std::string monitor = contents(folder_ / "r/monitor.csv");
  const std::string row = monitor.substr(monitor.rfind('\n', monitor.size() - 2) + 1);
  EXPECT_NEAR(std::stod(row), std::stod(entry(folder_ / "r/run.json", "time")), 1e-9) << row;
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

// An annulus of 72 000 particles takes all threads it may have.
TEST_F(DriverRunTest, FollowsOmpNumThreads) {
  const Words words{"run", "annulus", "--steps", "1", "--force", "--out", "r"};
  setenv("OMP_NUM_THREADS", "1", 1);
  EXPECT_EQ(run(words), 0) << err();
  EXPECT_NE(contents(folder_ / "r/run.json").find("\"threads\": 1,"), std::string::npos);
  unsetenv("OMP_NUM_THREADS");
  EXPECT_EQ(run(words), 0) << err();
  EXPECT_NE(contents(folder_ / "r/run.json")
                .find("\"threads\": " + std::to_string(omp_get_num_procs()) + ","),
            std::string::npos)
      << "(where a control group allows fewer cores than there are, this fails)";
}

// On one core a team would wait for each other's turn at every stage: one thread runs, and is said.
TEST_F(DriverRunTest, StartsNoMoreThreadsThanCores) {
  cpu_set_t allowed, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  std::size_t first = 0;
  while (!CPU_ISSET(first, &allowed)) ++first;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);  // the program inherits it
  for (const char* kernel : {"mirror", "ring", "annulus", "csr"}) {
    for (const char* threads : {"16", "256"}) {
      SCOPED_TRACE(std::string(kernel) + " " + threads);
      EXPECT_EQ(run({"run", "example-2", "--steps", "10", "--kernel", kernel, "--threads", threads,
                     "--force", "--out", "r"}),
                0)
          << err();
      const std::string record = contents(folder_ / "r/run.json");
      EXPECT_NE(record.find("\"threads\": 1,"), std::string::npos);
      EXPECT_NE(record.find(std::string(threads) + " threads were asked for"), std::string::npos);
    }
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof allowed, &allowed), 0);
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
}  // namespace bounce
