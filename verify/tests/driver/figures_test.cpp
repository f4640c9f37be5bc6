// The figures that the program prints: the same whatever it writes and when, with error bars that a
// finer solution confirms, and with the error that was asked for.
#include <nlohmann/json.hpp>

#include <optional>

#include "verify/tests/driver/program_test.hpp"

namespace bounce {
namespace {

using Json = nlohmann::json;

// A small ball that falls on a floor within 0.15 s.
constexpr const char* falling = R"(
[ball]
radii = [1.0, 2.0]
per_ring = 12
centre = [0.0, 3.0]
[law]
elasticity = 1000.0
rest = "geometry"
[gravity]
acceleration = [0.0, -98.0]
[[wall]]
[time]
step = 1e-4
end = 0.4
)";

// The same between a floor and a slope, thrown and pulled aside.
constexpr const char* two_walls = R"(
[ball]
radii = [1.0, 2.0]
per_ring = 12
centre = [0.0, 2.2]
velocity = [3.0, 0.0]
[law]
elasticity = 1000.0
rest = "geometry"
[gravity]
acceleration = [5.0, -98.0]
[[wall]]
alpha = 0.3
beta = 0.0
[[wall]]
normal = [-0.8, 0.6]
offset = -2.6
alpha = 0.5
beta = -0.5
[time]
step = 1e-4
end = 0.2
)";

class DriverFiguresTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "falling.toml") << falling;
    std::ofstream(folder_ / "two-walls.toml") << two_walls;
  }
  // The "bounce" of a run, or nothing.
  std::optional<Json> figures(Words words) {
    words.insert(words.begin(), "run");
    words.insert(words.end(), {"--out", "out", "--force", "-q"});
    if (run(words) != 0) return std::nullopt;
    return Json::parse(contents(folder_ / "out/run.json"))["bounce"];
  }
  // The observables of a reference, or nothing.
  std::optional<Json> reference(Words words) {
    words.insert(words.begin(), "reference");
    words.insert(words.end(), {"--out", "reference", "--force"});
    if (run(words) != 0) return std::nullopt;
    return Json::parse(contents(folder_ / "reference/observables.json"))["observables"];
  }
};

Words set(Words words, const Words& settings) {
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  return words;
}

TEST_F(DriverFiguresTest, DoNotDependOnTheMonitor) {
  const std::vector<Words> runs{
      {"falling.toml"},
      {"falling.toml", "--ledger"},
      set({"example-2", "--kernel", "oracle", "--t-end", "0.01"},
          {"ball.centre=[0,7.002]", "ball.velocity=[0,-2]"}),
      {"two-walls.toml"},
      set({"falling.toml"}, {"wall.alpha=1", "wall.beta=-1"}),
      set({"falling.toml"}, {"wall.alpha=0.5", "wall.beta=-0.5"}),
      set({"falling.toml"}, {"ball.centre=[0,2]", "time.end=0.05"}),
      set({"falling.toml"}, {"time.method=leapfrog", "wall.contact=resolved"}),
      set({"falling.toml"}, {"time.method=pefrl"}),
      set({"falling.toml"}, {"time.method=blanes-moan-6", "wall.contact=located"})};
  for (const Words& words : runs) {
    std::optional<Json> first;
    for (const char* every : {"0.1", "0.01", "0.001"}) {
      const auto found = figures(set(words, {std::string("output.monitor_every=") + every}));
      ASSERT_TRUE(found) << words.back() << ": " << err();
      if (!first) first = found;
      for (const auto& [key, value] : found->items()) {
        // Energies are the ledger's, from first and last sample: the same, too.
        EXPECT_EQ(value, (*first)[key]) << words.back() << " " << key << " every " << every;
      }
    }
    EXPECT_TRUE((*first)["first_contact"].is_number()) << words.back();
    EXPECT_EQ((*first)["found_to"].size() + 1, first->size());
  }
}

// A step in single precision is not the one that times are said in; the program says by how much.
TEST_F(DriverFiguresTest, TheTimeThatWasIntegratedIsSaid) {
  ASSERT_EQ(run({"run", "falling.toml", "--t-end", "0.1", "--out", "single"}), 0) << err();
  const Json single = Json::parse(contents(folder_ / "single/run.json"));
  EXPECT_EQ(single["time"].get<double>(), 1000 * 1e-4);
  EXPECT_EQ(single["time_integrated"].get<double>(), 1000 * static_cast<double>(1e-4F));
  EXPECT_NE(out().find("add up to 0.0999999974738 s"), std::string::npos) << out();
  ASSERT_EQ(run({"run", "falling.toml", "--t-end", "0.1", "--set", "constants=double", "--out",
                 "double"}),
            0)
      << err();
  const Json whole = Json::parse(contents(folder_ / "double/run.json"));
  EXPECT_EQ(whole["time_integrated"], whole["time"]);
  EXPECT_EQ(out().find("add up to"), std::string::npos) << out();
}

// Nor do those of a reference depend on its samples; it was 0.14 and 0.147 for 0.147646.
TEST_F(DriverFiguresTest, OfAReferenceDoNotDependOnItsSamples) {
  const auto few = reference({"falling.toml", "--every", "0.02"});
  const auto many = reference({"falling.toml", "--every", "0.001"});
  ASSERT_TRUE(few && many) << err();
  for (const auto& [key, value] : few->items()) {
    const Json& other = (*many)[key];
    ASSERT_EQ(value["value"].is_null(), other["value"].is_null()) << key;
    if (value["value"].is_null()) continue;
    EXPECT_NEAR(value["value"].get<double>(), other["value"].get<double>(),
                value["error"].get<double>() + other["error"].get<double>())
        << key;
  }
  EXPECT_NEAR((*few)["first_contact"]["value"].get<double>(), 0.147645, 1e-6);
}

// Two coarse solutions have an error bar; two with a hundredth of the tolerance and a third of the
// step, whose errors are some hundred times smaller, lie within it.
TEST_F(DriverFiguresTest, BarsHoldAgainstAFinerReference) {
  const std::vector<Words> scenes{
      {"falling.toml", "--t-end", "0.3"},
      {"two-walls.toml"},
      set({"falling.toml", "--t-end", "0.3"}, {"wall.alpha=1", "wall.beta=-1"}),
      set({"falling.toml", "--t-end", "0.25"}, {"wall.alpha=0.5", "wall.beta=-0.5"})};
  for (Words words : scenes) {
    Words fine = words;
    words.insert(words.end(), {"--tolerance", "1e-12", "--step", "2e-3", "--every", "0.02"});
    fine.insert(fine.end(), {"--tolerance", "1e-14", "--step", "7e-4", "--every", "0.002"});
    const auto coarse = reference(words), finer = reference(fine);
    ASSERT_TRUE(coarse && finer) << words[0] << ": " << err();
    for (const auto& [key, value] : coarse->items()) {
      const Json& other = (*finer)[key];
      EXPECT_EQ(value["value"].is_null(), other["value"].is_null()) << key;
      if (value["value"].is_null() || value["error"].is_null()) continue;
      EXPECT_LE(std::abs(value["value"].get<double>() - other["value"].get<double>()),
                value["error"].get<double>() + other["error"].get<double>())
          << words[0] << " " << key;
    }
  }
}

// What is asked for is what comes out: within three times, against the reference.
TEST_F(DriverFiguresTest, AnAskedErrorIsInTheOutput) {
  struct Scene {
    std::string name;
    Words words;
    double error;  // in parts of what an observable is
  };
  const std::vector<Scene> scenes{
      {"falling", {"falling.toml", "--t-end", "0.25"}, 1e-4},
      {"two walls", {"two-walls.toml", "--t-end", "0.12"}, 1e-4},
      {"elastic", set({"falling.toml", "--t-end", "0.25"}, {"wall.alpha=1", "wall.beta=-1"}),
       1e-3}};
  const std::vector<std::pair<std::string, std::string>> names{
      {"height", "end_height"},       {"speed", "end_speed"},
      {"rebound", "rebound_height"},  {"contact_time", "contact_time"},
      {"energy_lost", "energy_lost"}, {"flattening", "greatest_flattening"}};
  for (const Scene& scene : scenes) {
    const auto truth = reference(scene.words);
    ASSERT_TRUE(truth) << scene.name << ": " << err();
    for (const auto& [observable, key] : names) {
      const double value = (*truth)[key]["value"].get<double>();
      // Of an energy that an elastic wall leaves alone: in parts of an erg.
      const double error = scene.error * std::max(std::abs(value), 0.1);
      Words words = scene.words;
      words.insert(words.end(), {"--error", std::to_string(error), "--observable", observable});
      const auto found = figures(words);
      if (!found) {  // no setting reaches it: nothing is promised
        EXPECT_NE(err().find("--error"), std::string::npos) << scene.name << " " << err();
        continue;
      }
      EXPECT_LE(std::abs((*found)[key].get<double>() - value),
                3.0 * error + (*truth)[key]["error"].get<double>())
          << scene.name << " " << observable;
    }
  }
}

}  // namespace
}  // namespace bounce
