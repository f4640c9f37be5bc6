// Long commands that are killed between two of their cases, and go on with those that they have done.
#include "driver/output/journal.hpp"

#include <nlohmann/json.hpp>

#include "driver/world/input_error.hpp"
#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

class JournalTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    output_ = folder_ / "out";
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_, output_;
  Invocation asked_{{"verify", "a b", "\"\n"}, "/some/where"};
};

TEST_F(JournalTest, KeepsCasesUntilAllAreDone) {
  {
    Journal journal(output_, asked_, "{\"e\":1}", false);
    journal.add("one", std::vector<double>{-0.0, 1e300});
    journal.add("two \"\n", std::string("text \xff\n"));
    EXPECT_EQ(journal.size(), 2U);
  }
  const auto asked = find_journal(output_);
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->arguments, asked_.arguments);
  EXPECT_EQ(asked->folder, asked_.folder);
  Journal journal(output_, asked_, "{\"e\":1}", false);
  EXPECT_EQ(journal.size(), 2U);
  const auto one = journal.find<std::vector<double>>("one");
  ASSERT_TRUE(one && one->size() == 2U);
  EXPECT_TRUE(std::signbit(one->front()));
  EXPECT_EQ(journal.find<std::string>("two \"\n"), "text \xff\n");
  EXPECT_FALSE(journal.find<std::string>("three"));
  EXPECT_FALSE(journal.find<double>("one"));  // not what it is
  journal.finish();
  EXPECT_FALSE(find_journal(output_));
  EXPECT_TRUE(fs::is_empty(folder_));
}

// Torn anywhere, and with any byte changed: what is before is believed, nothing false is.
TEST_F(JournalTest, BelievesNothingThatIsTornOrDamaged) {
  {
    Journal journal(output_, asked_, "{}", false);
    for (const char* key : {"a", "b", "c"}) journal.add(key, std::vector<double>(2, 0.1));
  }
  const fs::path path = folder_ / "out.journal";
  const std::string whole = contents(path);
  const std::size_t head = whole.find('\n') + 1;
  for (std::size_t at = head; at < whole.size(); ++at) {
    for (const bool torn : {true, false}) {
      std::string other = torn ? whole.substr(0, at) : whole;
      if (!torn) other[at] = static_cast<char>(other[at] ^ 1);
      std::ofstream(path, std::ios::binary) << other;
      Journal journal(output_, asked_, "{}", false);
      EXPECT_LE(journal.size(), torn ? 2U : 3U) << at;
      for (const char* key : {"a", "b", "c"}) {
        const auto values = journal.find<std::vector<double>>(key);
        EXPECT_TRUE(!values || *values == std::vector<double>(2, 0.1)) << at << key;
      }
    }
  }
}

TEST_F(JournalTest, OfAnotherTaskIsRefusedOrDropped) {
  { Journal(output_, asked_, "{\"e\":1}", false).add("one", 1.0); }
  EXPECT_THROW(Journal(output_, asked_, "{\"e\":2}", false), InputError);
  EXPECT_EQ(Journal(output_, asked_, "{\"e\":2}", true).size(), 0U);
  std::ofstream(folder_ / "out.journal") << "alien\nlines\n";
  EXPECT_THROW(Journal(output_, asked_, "{}", true), InputError);
  EXPECT_EQ(contents(folder_ / "out.journal"), "alien\nlines\n");
}

TEST_F(JournalTest, WithoutOutputKeepsNothing) {
  Journal journal("", asked_, "{}", false);
  journal.add("one", 1.0);
  journal.finish();
  EXPECT_EQ(journal.name(), "");
}

class DriverJournalTest : public ProgramTest {
 protected:
  // Kills the command as soon as it has done a case, and has it go on by bounce resume.
  void kill_and_resume(Words words, const std::string& out) {
    words.insert(words.end(), {"--out", out});
    const pid_t child = start(words);
    const fs::path journal = folder_ / (out + ".journal");
    for (int wait = 0; wait < 6000 && lines(contents(journal)) < 2; ++wait) {
      if (waitpid(child, nullptr, WNOHANG) != 0) FAIL() << "ended before it was killed " << err();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    kill(child, SIGKILL);
    ASSERT_EQ(finish(child), 1000 + SIGKILL);
    EXPECT_TRUE(!fs::exists(folder_ / out) || fs::is_empty(folder_ / out));
    ASSERT_EQ(ProgramTest::run({"resume", out}), 0) << err();
    EXPECT_NE(err().find("going on with a stopped command: "), std::string::npos) << err();
    EXPECT_FALSE(fs::exists(journal));
  }
  void run_whole(Words words, const std::string& out) {
    words.insert(words.end(), {"--out", out});
    ASSERT_EQ(ProgramTest::run(words), 0) << err();
  }
  // Of a table, less the column of that name.
  [[nodiscard]] std::string without(const std::string& column, const fs::path& csv) const {
    std::istringstream text(contents(folder_ / csv));
    std::string result, line;
    std::size_t place = std::string::npos;
    while (std::getline(text, line)) {
      std::istringstream cells(line);
      std::string cell;
      for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
        if (cell == column) place = i;
        if (i != place) result += cell + ",";
      }
      result += "\n";
    }
    return result;
  }
};

TEST_F(DriverJournalTest, Reference) {
  const Words words{"reference", "example-2", "--t-end", "0.3", "--tolerance", "1e-10"};
  run_whole(words, "whole");
  kill_and_resume(words, "cut");
  for (const char* name : {"reference.csv", "contacts.csv", "final.csv"}) {
    EXPECT_EQ(contents(folder_ / "whole" / name), contents(folder_ / "cut" / name)) << name;
  }
}

TEST_F(DriverJournalTest, Accuracy) {
  const Words words{"accuracy",
                    "example-1",
                    "--set",
                    "ball.centre=[0.0,7.002]",
                    "--set",
                    "ball.velocity=[0.0,-0.77]",
                    "--set",
                    "time.end=0.05",
                    "--every",
                    "0.005",
                    "--quick",
                    "--methods",
                    "listing,leapfrog,gsl-rkf45"};
  run_whole(words, "whole");
  kill_and_resume(words, "cut");
  EXPECT_EQ(without("seconds", "whole/accuracy.csv"), without("seconds", "cut/accuracy.csv"));
}

TEST_F(DriverJournalTest, Verify) {
  const Words words{"verify", "example-2", "--quick"};
  run_whole(words, "whole.txt");
  kill_and_resume(words, "cut.txt");
  const auto rows = [this](const char* name) {
    const std::string text = contents(folder_ / name);
    return text.substr(0, text.find("\ncommit "));
  };
  EXPECT_EQ(rows("whole.txt"), rows("cut.txt"));
}

TEST_F(DriverJournalTest, Extremes) {
  const Words words{"extremes", "--threads", "1", "--only", "offset-1e6", "--only", "elasticity-1"};
  run_whole(words, "whole");
  kill_and_resume(words, "cut");
  EXPECT_EQ(contents(folder_ / "whole/extremes.csv"), contents(folder_ / "cut/extremes.csv"));
}

TEST_F(DriverJournalTest, Signals) {
  const pid_t child = start({"verify", "example-2", "--out", "t.txt"});
  for (int wait = 0; wait < 6000 && lines(contents(folder_ / "t.txt.journal")) < 1; ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill(child, SIGTERM);
  EXPECT_EQ(finish(child), 128 + SIGTERM) << err();
  EXPECT_NE(err().find("\"bounce resume t.txt\", goes on with them"), std::string::npos) << err();
  EXPECT_FALSE(fs::exists(folder_ / "t.txt"));
}

}  // namespace
}  // namespace bounce
