// What a run writes, number by number: each file is written with made-up values, no two alike, and
// read back by name. So columns that are exchanged are seen, and one field in another's place.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>

#include "driver/output/extended_xyz.hpp"
#include "driver/output/ledger_csv.hpp"
#include "driver/output/monitor_csv.hpp"
#include "driver/run/run_record.hpp"
#include "driver/run/run_summary.hpp"
#include "driver/run/trouble_text.hpp"
#include "driver/scene/state_file.hpp"
#include "verify/tests/driver/file_contents.hpp"
#include "verify/tests/driver/written/read_json.hpp"
#include "verify/tests/driver/written/read_table.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

class RunFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-files-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

Sample made_up_sample(double size) {
  Sample sample;
  sample.kinetic = 1.5 * size;
  sample.bond = 20.25 * size;
  sample.gravity = 300.5 * size;
  sample.momentum = {4.5 * size, 5.5 * size};
  sample.angular_momentum = 6.5 * size;
  sample.centre = {7.5 * size, 8.5 * size};
  sample.lowest = 9.5 * size;
  sample.smallest_ratio = 0.0625 * size;
  sample.ratio_first = 71;
  sample.ratio_second = 72;
  sample.fastest_bond = 10.5 * size;
  sample.approach = 11.5 * size;
  sample.on_wall = static_cast<std::int64_t>(12 * size);
  return sample;
}

LedgerInterval made_up_interval(double size) {
  LedgerInterval interval;
  interval.contact = true;
  interval.reflections = static_cast<std::int64_t>(21 * size);
  interval.impulse = {22.5 * size, 23.5 * size};
  interval.torque = 24.5 * size;
  interval.kinetic = 25.5 * size;
  interval.gravity = 26.5 * size;
  interval.bond = 27.5 * size;
  interval.walls = 28.5 * size;
  interval.swing = 29.5 * size;
  interval.drift = 30.5 * size;
  interval.momentum_residual = {31.5 * size, 32.5 * size};
  interval.angular_residual = 33.5 * size;
  return interval;
}

// Energies are told since the first row, and what the ledger has per interval is added up.
TEST_F(RunFiles, MonitorCsvHasEachValueInItsColumn) {
  MonitorCsv monitor(folder_ / "m");
  monitor.write(0.0, made_up_sample(1.0), LedgerInterval{}, 0.125);
  monitor.write(0.25, made_up_sample(2.0), made_up_interval(1.0), 0.375);
  monitor.write(0.75, made_up_sample(4.0), made_up_interval(2.0), 0.625);
  monitor.close();
  const auto rows = read_table(contents(folder_ / "m"));
  ASSERT_EQ(rows.size(), 3U);
  const auto expected = [](double t, double size, double intervals, double part) {
    return Cells{{"t", t},
                 {"kinetic", 1.5 * (size - 1)},
                 {"bond", 20.25 * (size - 1)},
                 {"gravity", 300.5 * (size - 1)},
                 {"total", 322.25 * (size - 1)},
                 {"px", 4.5 * size},
                 {"py", 5.5 * size},
                 {"angular_momentum", 6.5 * size},
                 {"cx", 7.5 * size},
                 {"cy", 8.5 * size},
                 {"lowest", 9.5 * size},
                 {"smallest_ratio", 0.0625 * size},
                 {"on_wall", 12 * size},
                 {"walls", 28.5 * intervals},
                 {"drift", 30.5 * intervals},
                 {"impulse_x", 22.5 * intervals},
                 {"impulse_y", 23.5 * intervals},
                 {"stable_part", part}};
  };
  expect_row(rows[0], expected(0.0, 1.0, 0.0, 0.125));
  expect_row(rows[1], expected(0.25, 2.0, 1.0, 0.375));
  expect_row(rows[2], expected(0.75, 4.0, 3.0, 0.625));
}

TEST_F(RunFiles, LedgerCsvHasEachValueInItsColumn) {
  LedgerCsv ledger(folder_ / "l");
  ledger.write(0.25, made_up_interval(1.0));
  ledger.write(0.75, made_up_interval(2.0));
  ledger.close();
  const auto rows = read_table(contents(folder_ / "l"));
  ASSERT_EQ(rows.size(), 2U);
  for (const double size : {1.0, 2.0}) {
    expect_row(rows[size == 1.0 ? 0 : 1], {{"t", size == 1.0 ? 0.25 : 0.75},
                                           {"reflections", 21 * size},
                                           {"kinetic", 25.5 * size},
                                           {"gravity", 26.5 * size},
                                           {"bond", 27.5 * size},
                                           {"drift", 30.5 * size},
                                           {"swing", 29.5 * size},
                                           {"impulse_x", 22.5 * size},
                                           {"impulse_y", 23.5 * size},
                                           {"torque", 24.5 * size},
                                           {"residual_px", 31.5 * size},
                                           {"residual_py", 32.5 * size},
                                           {"residual_angular", 33.5 * size}});
  }
}

State made_up_state(std::size_t particles, double from = 0.0) {
  State state(particles);
  for (std::size_t i = 0; i < particles; ++i) {
    const double k = from + 1.0 / 3.0 + static_cast<double>(i);  // all digits
    state.x[i] = k;
    state.y[i] = -100.0 - k;
    state.vx[i] = 1e-7 * (200.0 + k);
    state.vy[i] = 1e9 * (300.0 + k);
  }
  return state;
}

void expect_particle(const Row& row, const State& state, std::size_t i,
                     const std::string& prefix = "") {
  const auto number = [&](const char* name) {
    return std::strtod(row.at(prefix + name).c_str(), nullptr);
  };
  EXPECT_EQ(number("x"), state.x[i]) << prefix << i;
  EXPECT_EQ(number("y"), state.y[i]) << prefix << i;
  EXPECT_EQ(number("vx"), state.vx[i]) << prefix << i;
  EXPECT_EQ(number("vy"), state.vy[i]) << prefix << i;
}

// With a state held over beside it, and without.
TEST_F(RunFiles, StatesHaveEachParticlesNumbers) {
  const State state = made_up_state(5), held = made_up_state(5, 1000.0);
  for (const bool with_held : {false, true}) {
    const fs::path path = folder_ / (with_held ? "h" : "s");
    {
      OutputFile file(path);
      write_state_csv(file, state, with_held ? std::optional(held) : std::nullopt);
      file.close();
    }
    const auto rows = read_table(contents(path));
    ASSERT_EQ(rows.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(rows[i].size(), with_held ? 9U : 5U);
      EXPECT_EQ(rows[i].at("i"), std::to_string(i + 1));
      expect_particle(rows[i], state, i);
      if (with_held) expect_particle(rows[i], held, i, "held_");
    }
    const FiledState back = read_state(path.string());
    EXPECT_TRUE(same_state(back.state, state));
    ASSERT_EQ(back.held.has_value(), with_held);
    if (with_held) {
      EXPECT_TRUE(same_state(*back.held, held));
    }
  }
}

// The columns are those that the line of properties names.
TEST_F(RunFiles, FramesHaveWhatTheirPropertiesSay) {
  const State state = made_up_state(6);
  ExtendedXyz frames(folder_ / "f", 2);
  frames.write(7, 0.25, made_up_state(6));
  frames.write(9, 0.75, state);
  frames.close();
  std::istringstream lines(contents(folder_ / "f"));
  std::string line;
  for (const auto& [step, time] : {std::pair{"7", "0.25"}, std::pair{"9", "0.75"}}) {
    std::getline(lines, line);
    EXPECT_EQ(line, "6");
    std::getline(lines, line);
    EXPECT_NE(line.find("Properties=species:S:1:pos:R:3:velo:R:3:ring:I:1 "), std::string::npos);
    EXPECT_NE(line.find(std::string(" Time=") + time + " "), std::string::npos) << line;
    EXPECT_NE(line.find(std::string(" Step=") + step + " "), std::string::npos) << line;
    for (std::size_t i = 0; i < 6; ++i) {
      std::getline(lines, line);
      std::istringstream words(line);
      Row row;
      words >> row["species"] >> row["x"] >> row["y"] >> row["z"] >> row["vx"] >> row["vy"] >>
          row["vz"] >> row["ring"];
      EXPECT_TRUE(words) << line;
      EXPECT_EQ(row["species"], "X");
      expect_particle(row, state, i);
      EXPECT_EQ(std::stod(row["z"]) + std::stod(row["vz"]), 0.0) << line;
      EXPECT_EQ(row["ring"], std::to_string(i / 2 + 1));
    }
  }
  EXPECT_FALSE(std::getline(lines, line)) << line;
}

// ---- run.json

WallBook made_up_book(double size) {
  WallBook book;
  book.reflections = static_cast<std::int64_t>(80 * size);
  book.kinetic.add(81.5 * size);
  book.gravity.add(82.5 * size);
  book.bond.add(83.5 * size);
  book.impulse_x.add(84.5 * size);
  book.impulse_y.add(85.5 * size);
  book.torque.add(86.5 * size);
  return book;
}

LedgerReport made_up_report() {
  LedgerReport ledger;
  ledger.full = true;
  ledger.change = 61.5;
  ledger.walls = -62.5;
  ledger.swing = 63.5;
  ledger.drift = 64.5;
  ledger.greatest_swing = 65.5;
  ledger.free_share = 0.5;
  ledger.impulse = {66.5, 67.5};
  ledger.torque = 68.5;
  ledger.lines = {{"momentum x", "cm/s", 71.5, 172.5, 273.5, -1},
                  {"energy", "erg", 74.5, 75.5, 76.5, 77}};
  ledger.books = {made_up_book(1.0), made_up_book(2.0)};
  ledger.missed = 78;
  ledger.otherwise = 79;
  return ledger;
}

RunRecord made_up_record() {
  RunRecord record;
  record.command = "bounce run it";
  record.scene_name = "it.toml";
  record.initial = "start.csv";
  record.advice = "do that";
  record.scene.title = "A title";
  record.scene.time.step = 0.25;
  record.scene.time.method = "pefrl";
  record.plan.kernel = "outer";
  record.plan.inside = "inner";
  record.plan.vector = VectorTarget::avx2;
  record.plan.lanes = 4;
  record.plan.threads = 3;
  record.plan.law = "a law";
  record.plan.walls = "some walls";
  record.plan.left_out = {"this"};
  record.plan.reasons = {"because", "so"};
  record.particles = 41;
  record.bonds = 42;
  record.steps_asked = 43;
  record.result.step = 44;
  record.result.steps_timed = 45;
  record.result.seconds = 0.5;
  record.result.start = made_up_sample(1.0);
  record.result.last = made_up_state(3);
  record.findings.ledger = made_up_report();
  record.findings.time_step = 0.25;
  record.step_check = StepCheck{{51.5, true, {52.5, 53, 54, 0.875}}, 55.5, 56.5};
  record.margin = Margin{57.5, 58.5, false, 6, 59, 60, 0.75};
  return record;
}

TEST(RunJson, HasEachValueUnderItsName) {
  const RunRecord record = made_up_record();
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(state_hash(record.result.last)));
  const Json json = Json::parse(run_json(record));
  expect_values(json, {{"/title", "A title"},
                       {"/scene", "it.toml"},
                       {"/initial", "start.csv"},
                       {"/command", "bounce run it"},
                       {"/status", "complete"},
                       {"/advice", "do that"},
                       {"/steps", 44},
                       {"/steps_asked", 43},
                       {"/time", 11.0},
                       {"/state_hash", hash},
                       {"/wall_seconds", 0.5},
                       {"/steps_per_second", 90.0},
                       {"/particles", 41},
                       {"/bonds", 42},
                       {"/method", "pefrl"},
                       {"/plan/kernel", "outer"},
                       {"/plan/inside", "inner"},
                       {"/plan/vector", "avx2"},
                       {"/plan/lanes", 4},
                       {"/plan/threads", 3},
                       {"/plan/law", "a law"},
                       {"/plan/walls", "some walls"},
                       {"/plan/left_out", {"this"}},
                       {"/plan/reasons", {"because", "so"}},
                       {"/stability/omega_max", 51.5},
                       {"/stability/omega_max_from", "lanczos"},
                       {"/stability/stable_step", 55.5},
                       {"/stability/part", 56.5},
                       {"/stability/greatest_part/part", 57.5},
                       {"/stability/greatest_part/from", "bound"},
                       {"/stability/greatest_part/at_most", 58.5},
                       {"/stability/greatest_part/step", 6},
                       {"/stability/greatest_part/time", 1.5},
                       {"/stability/greatest_part/bond", {60, 61}},
                       {"/stability/greatest_part/ratio", 0.75},
                       {"/energies_at_start/kinetic", 1.5},
                       {"/energies_at_start/bond", 20.25},
                       {"/energies_at_start/gravity", 300.5},
                       {"/energies_at_start/total", 322.25}});
  RunRecord other = record;
  other.initial.clear();
  other.advice.clear();
  other.plan.inside.clear();
  other.step_check->fastest.exact = false;
  other.margin->exact = true;
  other.result.status = RunStatus::interrupted;
  const Json plain = Json::parse(run_json(other));
  expect_values(plain, {{"/initial", nullptr},
                        {"/plan/inside", nullptr},
                        {"/status", "interrupted"},
                        {"/stability/omega_max_from", "bound"},
                        {"/stability/greatest_part/from", "lanczos"}});
  EXPECT_FALSE(plain.contains("advice"));
}

TEST(RunJson, HasTheLedgersNumbersUnderTheirNames) {
  RunFindings findings;
  findings.ledger = made_up_report();
  expect_values(ledger_json(findings), {{"/form", "full"},
                                        {"/closes", false},
                                        {"/energy_change", 61.5},
                                        {"/walls", -62.5},
                                        {"/swing", 63.5},
                                        {"/drift", 64.5},
                                        {"/greatest_swing", 65.5},
                                        {"/free_share", 0.5},
                                        {"/impulse", {66.5, 67.5}},
                                        {"/torque", 68.5},
                                        {"/lines/0/name", "momentum x"},
                                        {"/lines/0/unit", "cm/s"},
                                        {"/lines/0/residual", 71.5},
                                        {"/lines/0/rounding_walk", 172.5},
                                        {"/lines/0/allowed", 273.5},
                                        {"/lines/0/closes", true},
                                        {"/lines/1/name", "energy"},
                                        {"/lines/1/residual", 74.5},
                                        {"/lines/1/closes", false},
                                        {"/lines/1/first_step", 77},
                                        {"/missed", 78},
                                        {"/otherwise", 79},
                                        {"/wall/0/reflections", 80},
                                        {"/wall/0/kinetic", 81.5},
                                        {"/wall/0/gravity", 82.5},
                                        {"/wall/0/bond", 83.5},
                                        {"/wall/0/impulse", {84.5, 85.5}},
                                        {"/wall/0/torque", 86.5},
                                        {"/wall/1/reflections", 160},
                                        {"/wall/1/torque", 173.0}});
  findings.ledger.full = false;
  findings.ledger.lines[1].fault_step = -1;
  const Json samples = ledger_json(findings);
  expect_values(samples, {{"/form", "samples"}, {"/closes", true}});
  EXPECT_FALSE(samples.contains("wall"));
  EXPECT_FALSE(samples.contains("missed"));
}

TEST(RunJson, HasTheBouncesNumbersUnderTheirNames) {
  RunFindings findings;
  const std::vector<std::pair<std::optional<Figure> Bounce::*, const char*>> figures{
      {&Bounce::lowest_centre, "lowest_centre"},
      {&Bounce::lowest_centre_time, "lowest_centre_time"},
      {&Bounce::first_contact, "first_contact"},
      {&Bounce::last_contact, "last_contact"},
      {&Bounce::contact_time, "contact_time"},
      {&Bounce::rebound_height, "rebound_height"},
      {&Bounce::energy_lost, "energy_lost"},
      {&Bounce::greatest_flattening_time, "greatest_flattening_time"},
      {&Bounce::end_height, "end_height"},
      {&Bounce::end_speed, "end_speed"},
      {&Bounce::restitution, "restitution"},
      {&Bounce::greatest_flattening, "greatest_flattening"}};
  std::vector<std::pair<std::string, Json>> expected;
  for (std::size_t k = 0; k < figures.size(); ++k) {
    const auto number = static_cast<double>(k);
    const Figure figure{k < 10 ? 91.5 + number : 0.375 - 0.25 * (number - 10.0),
                        1e-9 * (1.0 + number)};
    findings.bounce.*figures[k].first = figure;
    expected.emplace_back(std::string("/") + figures[k].second, figure.value);
    expected.emplace_back(std::string("/found_to/") + figures[k].second, figure.found_to);
  }
  const Json json = bounce_json(findings);
  for (const auto& [at, value] : expected) expect_values(json, {{at, value}});
  EXPECT_EQ(json.size(), figures.size() + 1);
  const std::string text = summary_text(findings);
  for (const char* part :
       {"contact from 93.5 s to 94.5 s, 95.5 s in all", "centre lowest at 91.5 cm", "up to 96.5 cm",
        "coefficient of restitution 0.375", "greatest flattening 0.125 at 98.5 s"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
  // No more digits than were found.
  findings.bounce.first_contact = Figure{93.5129, 0.004};
  EXPECT_NE(summary_text(findings).find("contact from 93.51 s to"), std::string::npos)
      << summary_text(findings);
  for (const auto figure : {&Bounce::first_contact, &Bounce::last_contact, &Bounce::restitution}) {
    (findings.bounce.*figure).reset();
  }
  expect_values(bounce_json(findings), {{"/first_contact", nullptr},
                                        {"/last_contact", nullptr},
                                        {"/restitution", nullptr},
                                        {"/rebound_height", nullptr},
                                        {"/found_to/rebound_height", nullptr}});
}

TEST(RunJson, TellsTheTroubleByItsNumbers) {
  RunRecord record = made_up_record();
  record.result.status = RunStatus::unstable;
  record.result.trouble = Trouble{"it is lost", 30, 31, 32};
  record.result.trouble_step = 34;
  record.result.looked_from = 33;
  TroubleReport report;
  report.bond_class = "ring 1-ring 2";
  report.before = TroubledState{101.5, 0.625, EdgeDistance{102.5, 103.5}};
  report.refused = TroubledState{204.5, 0.1875, EdgeDistance{105.5, 106.5}};
  report.stable_step = 0.03125;
  record.trouble_report = report;
  const Json json = Json::parse(run_json(record));
  expect_values(json, {{"/status", "unstable"},
                       {"/trouble/step", 34},
                       {"/trouble/time", 8.5},
                       {"/trouble/looked_from", 33},
                       {"/trouble/particle", 31},
                       {"/trouble/bond", {32, 33}},
                       {"/trouble/bond_class", "ring 1-ring 2"},
                       {"/trouble/ratio", 0.1875},
                       {"/trouble/energy_jump", 103.0},
                       {"/trouble/refused/energy", 204.5},
                       {"/trouble/refused/ratio", 0.1875},
                       {"/trouble/refused/part", 105.5},
                       {"/trouble/refused/stable_step", 106.5},
                       {"/trouble/last_good/energy", 101.5},
                       {"/trouble/last_good/ratio", 0.625},
                       {"/trouble/last_good/part", 102.5},
                       {"/trouble/last_good/stable_step", 103.5},
                       {"/trouble/last_good/step", 44},
                       {"/trouble/stable_step", 0.03125}});
  EXPECT_EQ(json["trouble"]["message"],
            "unstable at step 34 (t = 8.5 s): it is lost; particle 31; bond 32-33");
  const std::string text = trouble_text(record);
  for (const char* part : {"bond 32-33, ring 1-ring 2: R/R0 = 0.188, a step before 0.625",
                           "energy: 204.5 erg, 103 erg of them",
                           "time step: 102.5 of the stable step a step before, 105.5 now",
                           "stable would have been: 0.031 s", "every step from 33 on"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
  EXPECT_NE(how_to_go_on(record, "dir").find("of step 44, is in dir/final.csv"), std::string::npos);
}

// The summary's lines on energy and ledgers.
TEST(RunSummary, TellsEachNumberWhereItBelongs) {
  RunFindings findings;
  findings.ledger = made_up_report();
  findings.time_step = 0.25;
  const std::string text = summary_text(findings);
  for (const char* part :
       {"energy: 62.5 erg lost to the walls, 64.5 erg gained from drift; it swings by 66 erg",
        "ledgers DO NOT CLOSE, every reflection booked", " 7.2e+01 cm/s (1.7e+02, 2.7e+02)",
        "energy DOES NOT CLOSE from step 77 (t = 19.25 s) on: 7.45e+01 erg left over, at most "
        "7.65e+01 explained",
        "78 reflections MISSED, 79 otherwise"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
}

}  // namespace
}  // namespace bounce
