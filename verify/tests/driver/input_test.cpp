// What is read: files that are not what they should be, pipes, and words that are misspelt.
#include "driver/scene/state_file.hpp"
#include "verify/tests/driver/program_test.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

const std::string ball =
    "[ball]\nradii = [1.0, 2.0]\nper_ring = 12\ncentre = [0.0, 3.0]\n"
    "[law]\nelasticity = 1000.0\nrest = \"geometry\"\n"
    "[gravity]\nacceleration = [0.0, -98.0]\n[[wall]]\n"
    "[time]\nstep = 1e-3\nend = 0.2\n[output]\nmonitor_every = 0.05\n";

// With a zero byte after each, or before.
std::string utf16(const std::string& text, bool little) {
  std::string wide;
  for (const char c : {'\xff', '\xfe'}) wide.insert(little ? wide.end() : wide.begin(), c);
  for (const char c : text) {
    wide.push_back(little ? c : '\0');
    wide.push_back(little ? '\0' : c);
  }
  return wide;
}

std::string with_ends(std::string text, const std::string& end) {
  for (auto at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + end.size())) {
    text.replace(at, 1, end);
  }
  return text;
}

class DriverInputTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("ball.toml", ball);
    ASSERT_EQ(run({"run", "ball.toml", "--out", "made", "-q", "--listing-frames"}), 0) << err();
    csv_ = contents(folder_ / "made/final.csv");
    listing_ = contents(folder_ / "made/BAL4.OUT");
  }
  void write(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  // One line with all of these in it, and exit code 2.
  void refused(const Words& words, const Words& parts) {
    EXPECT_EQ(run(words), 2) << words.back();
    EXPECT_EQ(lines(err()), 1) << err();
    for (const std::string& part : parts) {
      EXPECT_NE(err().find(part), std::string::npos) << part << " not in: " << err();
    }
    EXPECT_EQ(err().find('\0'), std::string::npos) << err();
  }
  // The last state of a run.
  State end_of(const Words& words) {
    Words all{"run", "--force", "-q", "--out", "r"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(run(all), 0) << err();
    return read_state((folder_ / "r/final.csv").string()).state;
  }
  std::string csv_, listing_;
};

TEST_F(DriverInputTest, AnEmptySceneIsRefused) {
  for (const char* text : {"", "\n\n", "# a scene\n", "\xef\xbb\xbf", "[ball]\n"}) {
    write("empty.toml", text);
    for (const char* command : {"run", "show", "stability"}) {
      refused({command, "empty.toml"}, {"empty.toml: the file ", "at least one key"});
    }
  }
}

TEST_F(DriverInputTest, ScenesInOtherEncodingsAreReadOrRefused) {
  const State end = end_of({"ball.toml"});
  for (const std::string& text : {std::string("\xef\xbb\xbf") + ball, with_ends(ball, "\r\n"),
                                  ball.substr(0, ball.size() - 1)}) {
    write("other.toml", text);
    EXPECT_TRUE(same_state(end_of({"other.toml"}), end));
  }
  write("other.toml", utf16(ball, true));
  refused({"run", "other.toml"}, {"other.toml:1: is not UTF-8 but UTF-16"});
  write("other.toml", utf16(ball, false));
  refused({"run", "other.toml"}, {"other.toml:1: is not UTF-8 but UTF-16"});
  write("other.toml", utf16(ball, true).substr(2));
  refused({"run", "other.toml"}, {"other.toml:1: holds a zero byte"});
  write("other.toml", with_ends(ball, "\r"));
  refused({"run", "other.toml"}, {"other.toml:1: ends with a carriage return alone"});
  for (const std::string bad :
       {"caf\xe9", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80"}) {
    write("other.toml", "[law]\np = 3\n# " + bad + "\n");
    refused({"run", "other.toml"}, {"other.toml:3: is not UTF-8"});
  }
  write("other.toml", "title = \"caf\xc3\xa9 \xf0\x9f\x8f\x80\"\n" + ball);
  EXPECT_TRUE(same_state(end_of({"other.toml"}), end));
}

TEST_F(DriverInputTest, StatesInOtherFormsAreReadOrRefused) {
  for (const std::string& text : {csv_, listing_}) {
    write("whole", text);
    const State end = end_of({"ball.toml", "--initial", "whole"});
    for (const std::string& same : {std::string("\xef\xbb\xbf") + text, with_ends(text, "\r\n"),
                                    text + "\n", text + "\r\n\r\n"}) {
      write("same", same);
      EXPECT_TRUE(same_state(end_of({"ball.toml", "--initial", "same"}), end));
    }
    write("bad", utf16(text, true));
    refused({"run", "ball.toml", "--initial", "bad"}, {"bad:1: is not UTF-8 but UTF-16"});
    write("bad", with_ends(text, "\r"));
    refused({"run", "ball.toml", "--initial", "bad"}, {"bad:1: ends with a carriage return alone"});
    const std::size_t third = text.find('\n', text.find('\n') + 1) + 1;
    write("bad", text.substr(0, third) + '\0' + text.substr(third));
    refused({"run", "ball.toml", "--initial", "bad"}, {"bad:3: holds a zero byte"});
    write("bad", text.substr(0, third) + "\x80" + text.substr(third));
    refused({"run", "ball.toml", "--initial", "bad"}, {"bad:3: is not UTF-8"});
    write("bad", "");
    refused({"run", "ball.toml", "--initial", "bad"}, {"bad: the file is empty"});
  }
}

TEST_F(DriverInputTest, AStateThatIsCutAnywhereIsRefused) {
  for (const std::string& text : {csv_, listing_}) {
    const auto all = lines(text);
    for (std::size_t less = 1; less < 60; ++less) {
      const std::string cut = text.substr(0, text.size() - less);
      write("cut", cut);
      const bool whole_lines = cut.ends_with('\n');
      refused({"run", "ball.toml", "--initial", "cut"},
              {whole_lines ? "cut: initial state = 23 particles"
                           : "cut:" + std::to_string(less < 50 ? all : lines(cut) + 1) +
                                 ": the last line has no end"});
    }
  }
}

TEST_F(DriverInputTest, PipesAreReadOnce) {
  write("whole.csv", csv_);
  const auto run_with = [this](const std::string& file, const std::string& words) {
    return shell("mkfifo pipe; cat " + file + " > pipe & \"$BOUNCE\" " + words +
                 "; code=$?; kill $! 2> none; wait; rm -f pipe none; exit $code");
  };
  for (const char* words :
       {"advise ball.toml --error 1e-2 --initial pipe", "run ball.toml --initial pipe --out a",
        "run ball.toml --error 1e-2 --initial pipe --out b",
        "stability ball.toml --predict --initial pipe",
        "stability ball.toml --e 1000 --flight-only --no-disturbed --methods leapfrog --periods 20 "
        "--initial pipe",
        "reference ball.toml --t-end 0.02 --initial pipe",
        "accuracy ball.toml --quick --methods leapfrog --contacts resolved --initial pipe"}) {
    EXPECT_EQ(run_with("whole.csv", words), 0) << words << err();
  }
  for (const char* words :
       {"run pipe --out c", "show pipe", "advise pipe --error 1e-2", "stability pipe --predict"}) {
    EXPECT_EQ(run_with("ball.toml", words), 0) << words << err();
  }
  write("paper.toml", "[time]\nend = 1e-4\n[output]\nmonitor_every = 1e-4\n");
  EXPECT_EQ(run_with("paper.toml", "verify pipe --quick"), 0) << err();
}

TEST_F(DriverInputTest, MessagesCanBeRead) {
  const std::string digits(150, '7');
  const auto short_of_digits = [&] {
    EXPECT_EQ(err().find(std::string(41, '7')), std::string::npos) << err();
  };
  refused({"run", "ball.toml", "--threads", digits}, {"--threads", "(150 digits)"});
  short_of_digits();
  refused({"run", "ball.toml", "--set", "law.elasticity=" + digits}, {"law.elasticity = "});
  short_of_digits();
  refused({"run", digits}, {"neither a built-in scene nor a file"});
  short_of_digits();
  write("bad.toml", "[time]\nmethod = \"leap\\u0000frog\\u001b[31m\"\n");
  refused({"run", "bad.toml"}, {"bad.toml:2: time.method = \"leap", "allowed is one of"});
  EXPECT_EQ(err().find('\x1b'), std::string::npos) << err();
  write("bad.toml", "[law]\n\"p\\u0000\" = 3\n");
  refused({"run", "bad.toml"}, {"no such key"});
  refused({"run", "two\nlines"}, {"two\\nlines: neither"});
  refused({"run", "\x80\x1b[31m"}, {"\\x80\\x1b[31m: neither"});
  // A title is text, whatever it holds.
  ASSERT_EQ(run({"run", "ball.toml", "--set", "title=\"a\\u0000b\\nc\"", "--out", "t"}), 0)
      << err();
  EXPECT_NE(out().find("a\\x00b\\nc\n"), std::string::npos) << out();
}

// What --set is given stands in the run's scene.toml, which has to be read again.
TEST_F(DriverInputTest, SettingsThatAreNoTextAreRefused) {
  refused({"run", "ball.toml", "--set", "title=two w\x91\x88rds"},
          {"--set title=two w\\x91\\x88rds: is not UTF-8"});
  refused({"show", "ball.toml", "--set", "title=a\rb"}, {"ends with a carriage return alone"});
}

TEST_F(DriverInputTest, AFileWithoutAnEndIsRefusedBeforeMemoryIsFull) {
  memory_ = rlim_t{1} << 30;
  refused({"run", "ball.toml", "--initial", "/dev/zero"},
          {"/dev/zero: more than 0.", " GB, which this process has no memory for"});
  refused({"show", "/dev/zero"}, {"/dev/zero: more than 0."});
}

TEST_F(DriverInputTest, NumbersThatAreNoneAreSaidAsSuch) {
  for (const char* value : {"nan", "-nan", "inf", "-inf"}) {
    std::string text = csv_;
    const auto at = text.find("\n1,") + 3;
    text.replace(at, text.find(',', at) - at, value);
    write("bad.csv", text);
    refused({"run", "ball.toml", "--initial", "bad.csv"}, {"bad.csv", "finite"});
    EXPECT_EQ(err().find("-nan"), std::string::npos) << err();
    refused({"reference", "ball.toml", "--every", value}, {"--every"});
    EXPECT_EQ(err().find("-nan"), std::string::npos) << err();
    refused({"run", "ball.toml", "--t-end", value}, {"--t-end: time.end = "});
    EXPECT_EQ(err().find("-nan"), std::string::npos) << err();
  }
}

TEST_F(DriverInputTest, MisspeltCommandsAndOptionsAreNamedWithTheNearest) {
  refused({"rnu", "ball.toml"}, {"rnu: no such command; did you mean run?"});
  refused({"stabilty"}, {"stabilty: no such command; did you mean stability?"});
  refused({"fly"}, {"fly: no such command (allowed are: list, show, run"});
  refused({"run", "ball.toml", "--stpes", "5"}, {"--stpes: no such option; did you mean --steps?"});
  refused({"run", "--otu", "x"}, {"--otu: no such option; did you mean --out?"});
  refused({"run", "ball.toml", "--fource"}, {"--fource: no such option; did you mean --force?"});
  refused({"advise", "ball.toml", "--eror=1"}, {"--eror: no such option; did you mean --error?"});
  refused({"run", "ball.toml", "--colour"}, {"--colour: no such option", "bounce run --help"});
  refused({"--versoin"}, {"--versoin: no such option; did you mean --version?"});
  refused({"run"}, {"SCENE is required"});
  refused({}, {"subcommand is required"});
}

}  // namespace
}  // namespace bounce
