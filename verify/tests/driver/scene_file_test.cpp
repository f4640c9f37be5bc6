// Scene files: every key goes round, every message says where and what, every built-in scene is
// sound.
#include "driver/scene/scene_file.hpp"

#include <functional>

#include <gtest/gtest.h>

#include "driver/scene/built_in_scenes.hpp"
#include "kernels/model/problem.hpp"

namespace bounce {
namespace {

// Field by field, apart from the table of keys that is under test.
void expect_same(const Scene& a, const Scene& b) {
  const auto same = [](Vec2 u, Vec2 v) { return u.x == v.x && u.y == v.y; };
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.constants, b.constants);
  EXPECT_EQ(a.ball.kind, b.ball.kind);
  EXPECT_EQ(a.ball.spacing, b.ball.spacing);
  EXPECT_EQ(a.ball.radii, b.ball.radii);
  EXPECT_EQ(a.ball.per_ring, b.ball.per_ring);
  EXPECT_TRUE(same(a.ball.centre, b.ball.centre));
  EXPECT_TRUE(same(a.ball.velocity, b.ball.velocity));
  EXPECT_EQ(a.ball.rounding, b.ball.rounding);
  EXPECT_EQ(a.law.p, b.law.p);
  EXPECT_EQ(a.law.q, b.law.q);
  EXPECT_EQ(a.law.elasticity, b.law.elasticity);
  EXPECT_EQ(a.law.rest, b.law.rest);
  EXPECT_TRUE(same(a.gravity, b.gravity));
  ASSERT_EQ(a.walls.size(), b.walls.size());
  for (std::size_t i = 0; i < a.walls.size(); ++i) {
    EXPECT_TRUE(same(a.walls[i].normal, b.walls[i].normal)) << i;
    EXPECT_EQ(a.walls[i].offset, b.walls[i].offset) << i;
    EXPECT_EQ(a.walls[i].alpha, b.walls[i].alpha) << i;
    EXPECT_EQ(a.walls[i].beta, b.walls[i].beta) << i;
  }
  EXPECT_EQ(a.time.step, b.time.step);
  EXPECT_EQ(a.time.end, b.time.end);
  EXPECT_EQ(a.time.method, b.time.method);
  EXPECT_EQ(a.output.frames_every, b.output.frames_every);
  EXPECT_EQ(a.output.frames_at, b.output.frames_at);
  EXPECT_EQ(a.output.monitor_every, b.output.monitor_every);
}

Scene parsed(const std::string& text) { return SceneFile::parse(text, "test.toml").scene(); }

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

std::string refusal(const std::string& text) {
  return message_of([&] { parsed(text); });
}

std::string set_refusal(const std::string& setting) {
  return message_of([&] {
    SceneFile file = SceneFile::find("example-2");
    file.set(setting);
    static_cast<void>(file.scene());
  });
}

// No value is a default, and every double needs all its digits.
Scene unusual_scene() {
  Scene scene;
  scene.title = "\n \"quoted\" 'single' \\ \t tab, \x01, \x7f, caf\xc3\xa9 = # [x]";
  scene.constants = Constants::double_precision;
  scene.ball = {.radii = {1.0 / 3.0, 5e-1, 7.000000000000001},
                .per_ring = 77,
                .centre = {-0.1, 1e2 / 3},
                .velocity = {-4e-3, 2.0},
                .rounding = Rounding::none};
  scene.law = {0.1 + 0.2, 17.3, 123456789.12345678, Rest::geometry};
  scene.gravity = {1e-300, -0.0};
  scene.walls = {{{0.6, 0.8}, -1.0 / 7.0, 1.0 / 9.0, -1.0 / 11.0}, {{1.0, 0.0}, -1e20, 0.25, -1.0}};
  scene.time = {1.0 / 1024.0, 1e5 / 3.0, "leapfrog"};
  scene.output = {2.0 / 3.0, {}, 1.0 / 49.0};
  return scene;
}

TEST(SceneFileTest, EveryKeyGoesRound) {
  Scene scene = unusual_scene();
  expect_same(parsed(to_toml(scene)), scene);
  scene.output.frames_every.reset();
  scene.output.frames_at = {0.0, 0.1, 1.0 / 3.0, 1e4};
  scene.walls.clear();
  expect_same(parsed(to_toml(scene)), scene);
  expect_same(parsed(""), Scene{});
}

TEST(SceneFileTest, EveryBuiltInSceneParsesValidatesBuildsAndGoesRound) {
  EXPECT_EQ(built_in_scenes().size(), 11U);
  for (const BuiltInScene& built_in : built_in_scenes()) {
    SCOPED_TRACE(built_in.name);
    const Scene scene = SceneFile::find(std::string(built_in.name)).scene();
    expect_same(parsed(to_toml(scene)), scene);
    EXPECT_FALSE(scene.title.empty());
    const std::size_t rings = scene.ball.radii.size();
    const auto columns = static_cast<std::size_t>(scene.ball.per_ring);
    const std::size_t bonds = make_problem(scene).bonds.bonds();
    if (scene.ball.kind == BallKind::disc) {
      EXPECT_EQ(bonds, 9570U);
    } else {
      EXPECT_EQ(bonds, (3 * rings - 2) * columns);
    }
  }
}

// The paper's examples, once more and apart from the files.
TEST(SceneFileTest, TheExamplesAreThePapers) {
  struct Row {
    const char* name;
    double elasticity, gravity, height, speed, alpha, beta, end;
    std::size_t walls;
  };
  for (const Row& row : {Row{"example-1", 1000, 0.098, 10, 0, 0, 0, 15, 1},
                         Row{"example-2", 16000, 0.098, 10, 0, 0, 0, 15, 1},
                         Row{"example-3", 1000, 0.98, 15, 0, 0, 0, 6, 1},
                         Row{"example-4", 16000, 0.98, 15, 0, 0, 0, 19.5, 1},
                         Row{"example-5", 16000, 0.098, 10, 4, 0, 0, 18, 1},
                         Row{"example-6", 16000, 0.098, 10, 4, 1, -1, 18, 1},
                         Row{"example-7", 16000, 0.098, 10, 0, 1, -1, 20, 2}}) {
    SCOPED_TRACE(row.name);
    const Scene scene = SceneFile::find(row.name).scene();
    EXPECT_EQ(scene.constants, Constants::single_precision);
    EXPECT_EQ(scene.ball.rounding, Rounding::listing);
    EXPECT_EQ(scene.law.rest, Rest::listing);
    EXPECT_EQ(scene.law.p, 3.0);
    EXPECT_EQ(scene.law.q, 5.0);
    EXPECT_EQ(scene.law.elasticity, row.elasticity);
    EXPECT_EQ(scene.gravity.y, -row.gravity);
    EXPECT_EQ(scene.ball.centre.y, row.height);
    EXPECT_EQ(scene.ball.velocity.x, row.speed);
    EXPECT_EQ(scene.time.step, 1e-6);
    EXPECT_EQ(scene.time.end, row.end);
    ASSERT_EQ(scene.walls.size(), row.walls);
    for (const Wall& wall : scene.walls) {
      EXPECT_EQ(wall.alpha, row.alpha);
      EXPECT_EQ(wall.beta, row.beta);
    }
  }
}

TEST(SceneFileTest, WholeNumbersStandForNumbers) {
  const Scene scene =
      parsed("[law]\nelasticity = 1000\n[ball]\nradii = [5, 6, 7.0]\ncentre = [0, 20]\n");
  EXPECT_EQ(scene.law.elasticity, 1000.0);
  EXPECT_EQ(scene.ball.centre.y, 20.0);
}

TEST(SceneFileTest, MessagesNameFileLineKeyValueAndWhatIsAllowed) {
  struct Case {
    const char* text;
    const char* message;
  };
  for (const Case& c : {
           Case{"[law]\np = 3\nq = 2.5\n", "test.toml:3: law.q = 2.5: allowed is more than p = 3"},
           Case{"[law]\np = \"x\"\n", "test.toml:2: law.p = \"x\": allowed is a number"},
           Case{"[ball]\nper_ring = 120.0\n",
                "test.toml:2: ball.per_ring = 120.0: allowed is a whole number"},
           Case{"title = 7\n", "test.toml:1: title = 7: allowed is text in quotes"},
           Case{"\nconstants = \"half\"\n",
                "test.toml:2: constants = \"half\": allowed is \"single\" or \"double\""},
           Case{"[ball]\ncentre = [1, 2, 3]\n",
                "test.toml:2: ball.centre = [ 1, 2, 3 ]: allowed is two numbers"},
           Case{"[ball]\nradii = [5, \"6\"]\n",
                "test.toml:2: ball.radii = [ 5, \"6\" ]: allowed is a list of"},
           Case{"[ball]\nradii = [5,\n 6,\n 6]\n",
                "test.toml:2: ball.radii[2] = 6: allowed is more than"},
           Case{"[ball]\nradii = [-5]\n",
                "test.toml:2: ball.radii[0] = -5: allowed is a finite number above 0"},
           Case{"[ball]\nper_ring = 1000000000000\n",
                "test.toml:2: ball.per_ring = 1000000000000: allowed is"},
           Case{"[ball]\ncentre = [nan, 0]\n",
                "test.toml:2: ball.centre = [nan, 0]: allowed is two finite"},
           Case{"[ball]\nradii = [1, 2]\n",
                "test.toml: law.rest = \"listing\" (the default): allowed is"},
           Case{"[time]\nstep = 0\n",
                "test.toml:2: time.step = 0: allowed is a finite number above 0"},
           Case{"[time]\nend = inf\n", "test.toml:2: time.end = inf: allowed is"},
           Case{"[time]\nmethod = \"euler\"\n",
                "test.toml:2: time.method = \"euler\": allowed is one of: listing"},
           Case{"[output]\nframes_at = [0, 99]\n",
                "test.toml:2: output.frames_at[1] = 99: allowed is 0 to"},
           Case{"[output]\nframes_at = [0]\nframes_every = 1\n",
                "test.toml:2: output.frames_at = "},
           Case{"[[wall]]\n[[wall]]\nalpha = 2\n",
                "test.toml:3: wall[1].alpha = 2: allowed is 0 (full"},
           Case{"[[wall]]\nnormal = [1, 1]\n",
                "test.toml:2: wall[0].normal = [1, 1]: allowed is a vector of length 1"},
           Case{"[wall]\nalpha = 1\n",
                "test.toml:1: wall = a table: allowed is a list of tables, [[wall]]"},
           Case{"wall = [1]\n", "test.toml:1: wall[0] = 1: allowed is a table, [[wall]]"},
           Case{"ball = 3\n", "test.toml:1: ball = 3: allowed is a table, [ball]"},
           Case{"[ball]\nradius = 3\n",
                "test.toml:2: ball.radius = 3: no such key; did you mean ball.radii?"},
           Case{"[[wall]]\nalhpa = 1\n",
                "test.toml:2: wall[0].alhpa = 1: no such key; did you mean wall.alpha?"},
           Case{"[bal]\nradii = [1]\n", "test.toml:1: bal = a table: no such key"},
           Case{"[law]\np = 3\np = 4\n", "test.toml:3: `p = 4` is not TOML: "},
           Case{"[law\n", "test.toml:1: `[law` is not TOML: "},
       }) {
    const std::string message = refusal(c.text);
    EXPECT_EQ(message.substr(0, std::string(c.message).size()), c.message) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line: " << message;
  }
}

TEST(SceneFileTest, ErrorsFoundWhileBuildingGetFileAndLineToo) {
  const SceneFile file = SceneFile::parse("[ball]\ncentre = [0, 2]\n[[wall]]\n", "test.toml");
  try {
    make_problem(file.scene());
    FAIL() << "a ball behind the wall was accepted";
  } catch (const SceneError& error) {
    const std::string message = file.explain(error).what();
    EXPECT_EQ(message.substr(0, 24), "test.toml:3: wall[0] = a") << message;
  }
}

TEST(SceneFileTest, SetChangesEveryKey) {
  // All lines of an unusual scene, one by one as settings, make that scene of another.
  const Scene scene = unusual_scene();
  SceneFile file = SceneFile::find("example-7");  // two walls, as the unusual scene has
  std::string table;
  int wall = -1;
  for (std::string text = to_toml(scene); !text.empty();) {
    const std::string line = text.substr(0, text.find('\n'));
    text.erase(0, line.size() + 1);
    if (line == "[[wall]]") {
      table = "wall[" + std::to_string(++wall) + "].";
    } else if (line.starts_with('[')) {
      table = line.substr(1, line.size() - 2) + ".";
    } else if (!line.empty()) {
      file.set(table + line);
    }
  }
  expect_same(file.scene(), scene);
}

TEST(SceneFileTest, SetTakesWordsWallsAndWhatReplacesWhat) {
  SceneFile file = SceneFile::find("example-7");
  file.set("constants=double");
  file.set(" title = two words ");
  file.set("wall.alpha=0.5");
  file.set("wall[1].beta = 0");
  file.set("output.frames_every=4");
  const Scene scene = file.scene();
  EXPECT_EQ(scene.constants, Constants::double_precision);
  EXPECT_EQ(scene.title, "two words");
  EXPECT_EQ(scene.walls[0].alpha, 0.5);
  EXPECT_EQ(scene.walls[1].alpha, 0.5);
  EXPECT_EQ(scene.walls[0].beta, -1.0);
  EXPECT_EQ(scene.walls[1].beta, 0.0);
  EXPECT_EQ(scene.output.frames_every, 4.0);
  EXPECT_TRUE(scene.output.frames_at.empty());
  file.set("output.frames_at=[1]");
  file.set("wall=[{normal=[1,0], offset=-50}]");
  EXPECT_FALSE(file.scene().output.frames_every);
  ASSERT_EQ(file.scene().walls.size(), 1U);
  EXPECT_EQ(file.scene().walls[0].offset, -50.0);
}

// Each key of each wall, one at a time: the wall named changes, and no other.
TEST(SceneFileTest, SetOfOneWallLeavesTheOthers) {
  const auto scene_with = [](const std::string& assignment) {
    SceneFile file = SceneFile::find("example-7");
    file.set(
        "wall=[{normal=[0,1], offset=-1}, {normal=[0,1], offset=-2}, {normal=[0,1], offset=-3}]");
    if (!assignment.empty()) file.set(assignment);
    return file.scene();
  };
  const Scene before = scene_with("");
  for (std::size_t w = 0; w < 3; ++w) {
    const std::string name = "wall[" + std::to_string(w) + "].";
    for (const char* value : {"normal=[1,0]", "offset=-9", "alpha=0.5", "beta=-0.5"}) {
      const Scene after = scene_with(name + value);
      ASSERT_EQ(after.walls.size(), 3U);
      for (std::size_t k = 0; k < 3; ++k) {
        const Wall& a = before.walls[k];
        const Wall& b = after.walls[k];
        const bool same = a.normal.x == b.normal.x && a.normal.y == b.normal.y &&
                          a.offset == b.offset && a.alpha == b.alpha && a.beta == b.beta;
        EXPECT_EQ(same, k != w) << name << value << ", wall " << k;
      }
    }
  }
  // The key without a number is every wall's.
  for (const Wall& wall : scene_with("wall.offset=-9").walls) EXPECT_EQ(wall.offset, -9.0);
}

TEST(SceneFileTest, SetRefusesWithTheSameSortOfMessage) {
  EXPECT_EQ(set_refusal("law.p=true"),
            "--set: law.p = true: allowed is a number, as in 0.5 or 1e-6");
  EXPECT_EQ(set_refusal("wall.alpha=2").substr(0, 40), "--set: wall[0].alpha = 2: allowed is 0 (");
  EXPECT_EQ(set_refusal("wall[1].alpha=1"),
            "--set: wall[1].alpha = 1: the scene has 1 wall(s), numbered from 0");
  for (const char* misspelt : {"alpha=1", "wall.alhpa=1", "wall[0].alfa=1"}) {
    EXPECT_NE(set_refusal(misspelt).find("no such key; did you mean wall.alpha?"),
              std::string::npos)
        << set_refusal(misspelt);
  }
  EXPECT_NE(set_refusal("law.elasticty=1").find("did you mean law.elasticity?"), std::string::npos);
  for (const char* bad :
       {"x", "", "=", "ball=3", "wall[x].alpha=1", "wall[-1].alpha=1", "wall[0]=1", "wall=3",
        "law.p=1\nq=2", "time.end=nan", "ball.radii=[5,6", "wall.=1"}) {
    EXPECT_EQ(set_refusal(bad).substr(0, 5), "--set") << bad << ": " << set_refusal(bad);
  }
}

TEST(SceneFileTest, EndAtDropsLaterFrames) {
  SceneFile file = SceneFile::find("example-4");
  file.end_at(1.5, "--t-end");
  EXPECT_EQ(file.scene().time.end, 1.5);
  EXPECT_EQ(file.scene().output.frames_at, (std::vector<double>{0.0, 1.5}));
  file.end_at(-1.0, "--t-end");
  EXPECT_EQ(message_of([&] { static_cast<void>(file.scene()); }).substr(0, 23),
            "--t-end: time.end = -1:");
}

TEST(SceneFileTest, UnknownScenesAreRefused) {
  EXPECT_NE(message_of([] { SceneFile::find("exampel-2"); }).find("did you mean example-2?"),
            std::string::npos);
  EXPECT_NE(message_of([] { SceneFile::find("./no-such.toml"); }).find("cannot be read"),
            std::string::npos);
  EXPECT_NE(message_of([] { SceneFile::find("/"); }).find("cannot be read"), std::string::npos);
}

// The author's file had four decimals; other balls have what their scene says.
TEST(SceneFile, RoundsTheStartOfThePapersBallAlone) {
  const auto rounding = [](const std::string& text) {
    return SceneFile::parse(text, "test.toml").scene().ball.rounding;
  };
  EXPECT_EQ(rounding("[ball]\ncentre = [0.0, 10.0]\n"), Rounding::listing);
  EXPECT_EQ(rounding("[ball]\nradii = [5.0, 6.0, 7.0]\n"), Rounding::listing);
  const std::string geometry = "[law]\nrest = \"geometry\"\n";
  EXPECT_EQ(rounding(geometry + "[ball]\nradii = [5.0, 6.0, 8.0]\n"), Rounding::none);
  EXPECT_EQ(rounding(geometry + "[ball]\nper_ring = 60\n"), Rounding::none);
  EXPECT_EQ(rounding(geometry + "[ball]\nper_ring = 60\nrounding = \"listing\"\n"),
            Rounding::listing);
}

}  // namespace
}  // namespace bounce
