// What bounce reference writes, number by number: made-up values, no two alike, read back by name.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "driver/accuracy/reference_record.hpp"
#include "verify/tests/driver/file_contents.hpp"
#include "verify/tests/driver/written/read_json.hpp"
#include "verify/tests/driver/written/read_table.hpp"

namespace bounce {
namespace {

// Two particles at two times; every number of the two solutions and the disturbed one is another.
ReferenceRecord made_up_reference() {
  ReferenceRecord record;
  ReferencePair& pair = record.paths.pair;
  pair.times = {0.25, 0.75};
  const auto state = [](double x) {
    State two(2);
    two.x = {0.0, x};
    return two;
  };
  pair.fixed.states = {state(10.0), state(20.0)};
  pair.adaptive.states = {state(10.5), state(20.25)};
  record.paths.disturbed.states = {state(11.5), state(24.25)};
  pair.fixed.run = {
      {{0.5, 3, 1, ContactKind::lands}, {0.6, 4, 2, ContactKind::releases}}, 51, 52, 53.5};
  pair.adaptive.run = {{{0.7, 5, 0, ContactKind::bounces}}, 54, 55, 56.5};
  const auto sample = [](double size) {
    Sample s;
    s.kinetic = 61.5 * size;
    s.bond = 62.5 * size;
    s.gravity = 63.5 * size;
    s.momentum = {6.0 * size, 8.0 * size};
    s.centre = {64.5 * size, 65.5 * size};
    s.lowest = 66.5 * size;
    return s;
  };
  record.fixed = {sample(1.0), sample(2.0)};
  record.adaptive = {sample(1.5), sample(3.5)};
  record.disturbance = 67.5;
  return record;
}

std::string written(const fs::path& path, const ReferenceRecord& record,
                    void (*write)(OutputFile&, const ReferenceRecord&)) {
  fs::remove(path);
  {
    OutputFile file(path);
    write(file, record);
    file.close();
  }
  std::string text = contents(path);
  fs::remove(path);
  return text;
}

TEST(ReferenceFiles, HaveEachValueInItsColumn) {
  const ReferenceRecord record = made_up_reference();
  const fs::path path =
      fs::temp_directory_path() / ("bounce-reference-" + std::to_string(getpid()) + ".csv");
  const auto rows = read_table(written(path, record, write_reference_csv));
  ASSERT_EQ(rows.size(), 2U);
  // Per particle of two; the second column of each pair: adaptive less fixed.
  const auto expected = [](double t, double f, double a, double apart, double disturbed) {
    return Cells{{"t", t},
                 {"cx", 64.5 * f},
                 {"cx_diff", 64.5 * (a - f)},
                 {"cy", 65.5 * f},
                 {"cy_diff", 65.5 * (a - f)},
                 {"vx", 3.0 * f},
                 {"vx_diff", 3.0 * (a - f)},
                 {"vy", 4.0 * f},
                 {"vy_diff", 4.0 * (a - f)},
                 {"kinetic", 61.5 * f},
                 {"kinetic_diff", 61.5 * (a - f)},
                 {"bond", 62.5 * f},
                 {"bond_diff", 62.5 * (a - f)},
                 {"gravity", 63.5 * f},
                 {"gravity_diff", 63.5 * (a - f)},
                 {"lowest", 66.5 * f},
                 {"lowest_diff", 66.5 * (a - f)},
                 {"position_diff", apart},
                 {"disturbed_by", disturbed}};
  };
  const auto to_three_digits = [](Cells cells) {
    for (auto& [name, cell] : cells) {
      if (!name.ends_with("_diff")) continue;
      char text[32];
      std::snprintf(text, sizeof text, "%.3g", cell.number);
      cell.number = std::stod(text);
    }
    return cells;
  };
  expect_row(rows[0], to_three_digits(expected(0.25, 1.0, 1.5, 0.5, 1.0)));
  expect_row(rows[1], to_three_digits(expected(0.75, 2.0, 3.5, 0.25, 4.0)));
  const auto contacts = read_table(written(path, record, write_contacts_csv));
  ASSERT_EQ(contacts.size(), 3U);
  expect_row(
      contacts[0],
      {{"solution", "fixed"}, {"t", 0.5}, {"particle", 4.0}, {"wall", 1.0}, {"what", "lands"}});
  expect_row(
      contacts[1],
      {{"solution", "fixed"}, {"t", 0.6}, {"particle", 5.0}, {"wall", 2.0}, {"what", "releases"}});
  expect_row(contacts[2], {{"solution", "adaptive"},
                           {"t", 0.7},
                           {"particle", 6.0},
                           {"wall", 0.0},
                           {"what", "bounces"}});
}

// Number by number of each figure: what the solutions have, and their difference.
TEST(ReferenceFiles, ObservablesHaveTheirValuesAndErrors) {
  ReferenceRecord record = made_up_reference();
  Bounce& f = record.fixed_bounce;
  Bounce& a = record.adaptive_bounce;
  struct Made {
    const char* name;
    std::optional<Figure> Bounce::*figure;
    double fixed, adaptive;
  };
  const std::vector<Made> figures{
      {"rebound_height", &Bounce::rebound_height, 71.0, 71.5},
      {"contact_time", &Bounce::contact_time, 72.0, 71.25},
      {"energy_lost", &Bounce::energy_lost, 73.0, 74.0},
      {"greatest_flattening", &Bounce::greatest_flattening, 0.5, 0.375},
      {"greatest_flattening_time", &Bounce::greatest_flattening_time, 75.0, 76.5},
      {"lowest_centre", &Bounce::lowest_centre, 77.0, 79.0},
      {"lowest_centre_time", &Bounce::lowest_centre_time, 80.0, 83.0},
      {"first_contact", &Bounce::first_contact, 84.0, 88.0},
      {"last_contact", &Bounce::last_contact, 89.0, 94.0},
      {"restitution", &Bounce::restitution, 0.75, 0.6875},
      {"end_height", &Bounce::end_height, 131.0, 229.25},
      {"end_speed", &Bounce::end_speed, 10.0, 17.5},
  };
  for (const Made& each : figures) {
    f.*each.figure = Figure{each.fixed, 1e-3};
    a.*each.figure = Figure{each.adaptive, 2e-3};
  }
  Scene scene;
  scene.time.end = 2.5;
  ReferenceSettings settings;
  settings.adaptive.tolerance = 1e-7;
  settings.fixed.step = 0.0625;
  const Json json =
      Json::parse(reference_json(record, scene, settings, 0.125, "it.toml", "bounce reference it"));
  for (const Made& each : figures) {
    const std::string at = std::string("/observables/") + each.name;
    expect_values(json, {{at + "/value", each.fixed},
                         {at + "/error", 2.0 * std::abs(each.fixed - each.adaptive)}});
  }
  expect_values(json, {{"/observables/end_height/value", 131.0},
                       {"/observables/end_height/error", 196.5},
                       {"/observables/end_height/unit", "cm"},
                       {"/observables/end_speed/value", 10.0},
                       {"/observables/end_speed/error", 15.0},
                       {"/observables/end_speed/unit", "cm/s"},
                       {"/observables/restitution/value", 0.75},
                       {"/observables/restitution/error", 0.125},
                       {"/observables/contact_time/unit", "s"},
                       {"/observables/energy_lost/unit", "erg"},
                       {"/scene", "it.toml"},
                       {"/end", 2.5},
                       {"/every", 0.125},
                       {"/before_impact/t", 0.25},
                       {"/before_impact/first_contact", 0.5},
                       {"/before_impact/position_error", 0.5},
                       {"/end_position_error", 0.25},
                       {"/growth/disturbed_by", 67.5},
                       {"/growth/start", 1.0},
                       {"/growth/at_contact", 1.0},
                       {"/growth/end", 4.0},
                       {"/growth/greatest", 4.0},
                       {"/growth/factor", 4.0},
                       {"/growth/rate", std::log(4.0) / 0.5},
                       {"/adaptive/steps", 54},
                       {"/adaptive/force_evaluations", 55},
                       {"/adaptive/contacts", 1},
                       {"/adaptive/height_cut_cm", 56.5},
                       {"/adaptive/tolerance", 1e-7},
                       {"/fixed/steps", 51},
                       {"/fixed/force_evaluations", 52},
                       {"/fixed/contacts", 2},
                       {"/fixed/height_cut_cm", 53.5},
                       {"/fixed/step", 0.0625},
                       {"/origin/command", "bounce reference it"}});
  // The bar is no less than what either was found to.
  f.contact_time = Figure{72.0, 1.625};
  a.lowest_centre = Figure{79.0, 4.5};
  const Json wide =
      Json::parse(reference_json(record, scene, settings, 0.125, "it.toml", "bounce reference it"));
  expect_values(wide, {{"/observables/contact_time/error", 1.625},
                       {"/observables/lowest_centre/error", 4.5}});
  record.paths.pair.fixed.run.events.clear();
  record.paths.pair.adaptive.run.events.clear();
  const Json untouched =
      Json::parse(reference_json(record, scene, settings, 0.125, "it.toml", "bounce reference it"));
  expect_values(untouched, {{"/before_impact/first_contact", nullptr}});
}

}  // namespace
}  // namespace bounce
