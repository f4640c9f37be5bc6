// bounce reference as a user runs it.
#include <nlohmann/json.hpp>

#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

class DriverReferenceTest : public ProgramTest {
 protected:
  int run(Words words) {
    words.insert(words.begin(), "reference");
    return ProgramTest::run(words);
  }
  // Nothing but what the shell made.
  [[nodiscard]] bool left_nothing() const {
    return std::all_of(fs::directory_iterator(folder_), fs::directory_iterator{},
                       [](const fs::directory_entry& entry) {
                         const std::string name = entry.path().filename().string();
                         return name == "stdout" || name == "stderr" ||
                                (name == "runs" && fs::is_empty(entry.path()));
                       });
  }
  // Just above the axis at the speed of its impact.
  static Words landing(Words more) {
    Words words{"example-1", "--set", "ball.centre=[0,7.01]", "--set", "ball.velocity=[0,-0.767]"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

TEST_F(DriverReferenceTest, WritesItsDirectoryWhole) {
  ASSERT_EQ(run(landing({"--t-end", "0.045"})), 0) << err();
  const fs::path made = folder_ / "runs/example-1-reference";
  const auto json = nlohmann::json::parse(contents(made / "observables.json"));
  // 0, 0.01 ... 0.04, and the end.
  EXPECT_EQ(lines(contents(made / "reference.csv")), 1 + 6);
  EXPECT_EQ(lines(contents(made / "final.csv")), 1 + 360);
  EXPECT_EQ(lines(contents(made / "before-impact.csv")), 1 + 360);
  const auto contacts = json["fixed"]["contacts"].get<int>();
  EXPECT_GE(contacts, 3);
  EXPECT_EQ(lines(contents(made / "contacts.csv")),
            1 + contacts + json["adaptive"]["contacts"].get<int>());
  EXPECT_TRUE(fs::exists(made / "scene.toml"));
  EXPECT_EQ(json["before_impact"]["t"], 0.01);
  EXPECT_LE(json["before_impact"]["position_error"].get<double>(), 1e-11);
  EXPECT_NEAR(json["observables"]["end_height"]["value"].get<double>(), 7.01 - 0.045 * 0.767, 1e-3);
  const double error = json["observables"]["end_height"]["error"].get<double>();
  EXPECT_GT(error, 0.0);
  EXPECT_LE(error, 1e-11);
  EXPECT_GT(json["growth"]["factor"].get<double>(), 0.0);
  EXPECT_FALSE(json["origin"]["commit"].get<std::string>().empty());
  EXPECT_NE(out().find("end_height"), std::string::npos);

  EXPECT_EQ(run(landing({"--t-end", "0.02"})), 2);
  EXPECT_NE(err().find("--force"), std::string::npos) << err();
  EXPECT_EQ(run(landing({"--t-end", "0.02", "--force"})), 0) << err();
  EXPECT_EQ(lines(contents(made / "reference.csv")), 1 + 3);
}

TEST_F(DriverReferenceTest, TellsOfNoContactWhereThereIsNone) {
  ASSERT_EQ(run(landing({"--t-end", "0.005", "--every", "0.001"})), 0) << err();
  EXPECT_EQ(out().find("the first contact"), std::string::npos) << out();
  EXPECT_NE(out().find("cm at the end"), std::string::npos) << out();
}

TEST_F(DriverReferenceTest, RefusesWithOneMessageAndLeavesNothing) {
  const auto refused = [&](const Words& words, const std::string& why) {
    EXPECT_EQ(run(words), 2) << words.back();
    EXPECT_EQ(lines(err()), 1) << err();
    EXPECT_NE(err().find(why), std::string::npos) << err();
    EXPECT_TRUE(left_nothing());
  };
  refused({"example-1", "--tolerance", "nan"}, "--tolerance");
  refused({"example-1", "--tolerance", "1"}, "--tolerance");
  refused({"example-1", "--step", "-1"}, "--step");
  refused({"example-1", "--every", "0"}, "--every");
  refused({"example-1", "--every", "1e-6"}, "GB");
  refused({"example-1", "--disturbed", "0"}, "--disturbed");
  refused({"example-1", "--set", "ball.centre=[0,6.99995]", "--set", "ball.rounding=none"},
          "behind wall[0]");
  refused({"nowhere"}, "nowhere");
}

}  // namespace
}  // namespace bounce
