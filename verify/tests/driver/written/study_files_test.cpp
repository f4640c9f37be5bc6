// What the studies write (stability, accuracy, extremes, verify), number by number: made-up
// values, no two alike, read back by name.
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "driver/accuracy/accuracy_table.hpp"
#include "driver/equivalence_table.hpp"
#include "driver/extremes/extreme_table.hpp"
#include "driver/stability/edge_row.hpp"
#include "driver/stability/edge_table.hpp"
#include "verify/tests/driver/written/read_table.hpp"

namespace bounce {
namespace {

// ---- edge.csv

EdgeCase made_up_case(Passage passage, Sought sought) {
  EdgeCase what;
  what.scene.time.method = "pefrl";
  what.scene.law.elasticity = 11.5;
  what.scene.time.step = 0.125;
  what.scene.gravity = {3.0, -4.0};
  what.passage = passage;
  what.sought = sought;
  what.speed = 12.5;
  what.disturbance = 0.25;
  what.criterion = {13.5, 14.5};
  return what;
}

Edge made_up_edge() {
  Edge edge;
  edge.outcome = EdgeOutcome::found;
  edge.stable = 42.0;
  edge.unstable = 22.5;
  edge.predicted = 24.0;
  edge.strict = 23.5;
  edge.flight = 25.5;
  edge.used = 0.875;
  edge.ratio = 0.625;
  edge.speed = 12.5;
  edge.left = true;
  edge.runs = 26;
  edge.steps = 27;
  return edge;
}

TEST(EdgeCsv, HasEachValueInItsColumn) {
  const Edge edge = made_up_edge();
  const auto row_of = [&](Passage passage, Sought sought, const Edge& of) {
    const std::string key = edge_key(made_up_case(passage, sought));
    return read_table(edge_header + edge_line(key, of, 28.5) + "\n").at(0);
  };
  Cells expected{{"method", "pefrl"},
                 {"passage", "bounce"},
                 {"sought", "dt"},
                 {"E", 11.5},
                 {"dt", ""},
                 {"g", 5.0},
                 {"speed", 12.5},
                 {"disturbed", 0.25},
                 {"growth", 13.5},
                 {"periods", 14.5},
                 {"outcome", "found"},
                 {"predicted", 24.0},
                 {"strict", 23.5},
                 {"stable", 42.0},
                 {"unstable", 22.5},
                 {"flight", 25.5},
                 {"measured_over_predicted", 1.75},
                 {"part_used_at_edge", 0.875},
                 {"smallest_ratio", 0.625},
                 {"left_wall", 1.0},
                 {"runs", 26.0},
                 {"steps", 27.0},
                 {"seconds", 28.5}};
  expect_row(row_of(Passage::bounce, Sought::step, edge), expected);
  expected.at("passage") = "flight";
  expected.at("sought") = "E";
  expected.at("E") = "";
  expected.at("dt") = 0.125;
  expected.at("g") = 0.0;  // there is none in flight
  expect_row(row_of(Passage::flight, Sought::elasticity, edge), expected);
  Edge refused = edge;
  refused.outcome = EdgeOutcome::refused;
  refused.why = "too large, by far";
  refused.left = false;
  expected.at("outcome") = "refused: too large; by far";
  expected.at("left_wall") = 0.0;
  expect_row(row_of(Passage::flight, Sought::elasticity, refused), expected);
}

TEST(EdgeCsv, IsReadBackAsItWasWritten) {
  const Edge edge = made_up_edge();
  for (const Passage passage : {Passage::flight, Passage::bounce}) {
    for (const Sought sought : {Sought::step, Sought::elasticity}) {
      const auto row =
          read_edge_line(edge_line(edge_key(made_up_case(passage, sought)), edge, 28.5));
      ASSERT_TRUE(row);
      EXPECT_EQ(row->method, "pefrl");
      EXPECT_EQ(row->passage, passage);
      EXPECT_EQ(row->sought, sought);
      const bool step = sought == Sought::step;
      EXPECT_TRUE(step ? row->elasticity == 11.5 : std::isnan(row->elasticity));
      EXPECT_TRUE(step ? std::isnan(row->step) : row->step == 0.125);
      EXPECT_EQ(row->gravity, passage == Passage::flight ? 0.0 : 5.0);
      EXPECT_EQ(row->disturbance, 0.25);
      EXPECT_EQ(row->criterion.growth, 13.5);
      EXPECT_EQ(row->criterion.periods, 14.5);
      EXPECT_EQ(row->seconds, 28.5);
      EXPECT_EQ(row->edge.outcome, edge.outcome);
      EXPECT_EQ(row->edge.stable, edge.stable);
      EXPECT_EQ(row->edge.unstable, edge.unstable);
      EXPECT_EQ(row->edge.predicted, edge.predicted);
      EXPECT_EQ(row->edge.strict, edge.strict);
      EXPECT_EQ(row->edge.flight, edge.flight);
      EXPECT_EQ(row->edge.used, edge.used);
      EXPECT_EQ(row->edge.ratio, edge.ratio);
      EXPECT_EQ(row->edge.speed, edge.speed);
      EXPECT_EQ(row->edge.left, edge.left);
      EXPECT_EQ(row->edge.runs, edge.runs);
      EXPECT_EQ(row->edge.steps, edge.steps);
    }
  }
  for (const EdgeOutcome outcome : {EdgeOutcome::always_stable, EdgeOutcome::always_unstable}) {
    Edge other = edge;
    other.outcome = outcome;
    const auto row = read_edge_line(edge_line(edge_key(made_up_case({}, {})), other, 1.0));
    ASSERT_TRUE(row);
    EXPECT_EQ(row->edge.outcome, outcome);
  }
}

// The words of the line of a text that begins with `first`.
std::vector<std::string> words_of_line(const std::string& text, const std::string& first) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(first + " ")) continue;
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
  }
  return {};
}

TEST(EdgeTable, HasEachNumberInItsColumn) {
  EdgeRow flight;
  flight.method = "pefrl";
  flight.elasticity = 16.0;
  flight.disturbance = edge_disturbance;
  flight.edge = made_up_edge();
  const auto section = [&](const EdgeRow& more, const char* heading) {
    const std::vector<EdgeRow> rows{flight, more};
    const std::string text = edge_table(rows, 16.0, EdgeCriterion{});
    const auto at = text.find(heading);
    return words_of_line(at == std::string::npos ? "" : text.substr(at), "pefrl");
  };
  using Words = std::vector<std::string>;
  // dt sqrt(E) = 42 * 4 and 23.5 * 4, 42 / 24 and 42 / 23.5.
  EXPECT_EQ(section(flight, "\nFree flight: largest"),
            (Words{"pefrl", "2", "16", "...", "16", "168", "94", "1.750", "...", "1.750", "1.787",
                   "...", "1.787"}));
  EdgeRow other = flight;
  other.criterion.periods = 5000.0;
  EXPECT_EQ(section(other, "\nThe strict limit"),
            (Words{"pefrl", "5000", "23.5", "42", "22.5", "1.787"}));
  other = flight;
  other.disturbance = 0.25;
  other.edge.predicted = 21.0;
  EXPECT_EQ(section(other, "disturbed more"), (Words{"pefrl", "0.25", "42", "2.000", "1.750"}));
  other = flight;
  other.sought = Sought::elasticity;
  other.step = 0.125;
  EXPECT_EQ(section(other, "\nLargest stable E at dt = 0.125 s"),
            (Words{"pefrl", "flight", "24", "42", "1.750"}));
  other = flight;
  other.passage = Passage::bounce;
  other.gravity = 5.0;
  other.edge.flight = 84.0;
  other.edge.left = false;
  EXPECT_EQ(section(other, "\nThrough a bounce"),
            (Words{"pefrl", "16", "12.5", "5", "42", "0.286", "0.500", "1.750", "0.625", "0.875",
                   "stays", "down"}));
  other = flight;
  other.criterion.growth = 1000.0;
  other.edge.stable = 43.0;
  EXPECT_EQ(section(other, "by other criteria"),
            (Words{"pefrl", "flight", "1000", "1000", "43", "1.792", "2.38", "%", "DEPENDS", "on",
                   "the", "criterion"}));
  EdgeRow above = other, below = other, refused = other;
  above.edge.outcome = EdgeOutcome::always_stable;
  below.edge.outcome = EdgeOutcome::always_unstable;
  refused.edge.outcome = EdgeOutcome::refused;
  refused.edge.why = "because";
  EXPECT_EQ(section(above, "by other criteria").at(5), "43");
  EXPECT_EQ(section(above, "by other criteria").at(4), ">");
  EXPECT_EQ(section(below, "by other criteria").at(4), "<");
  EXPECT_EQ(section(below, "by other criteria").at(5), "22.5");
  EXPECT_EQ(section(refused, "by other criteria").at(4), "because");
}

// ---- accuracy.csv

Observables made_up_observables(double from) {
  Observables all;
  all.height = from + 1.0;
  all.speed = from + 2.0;
  all.rebound = from + 3.0;
  all.contact = from + 4.0;
  all.lost = from + 5.0;
  all.flattening = from + 6.0;
  return all;
}

void add_observables(Cells& cells, const std::string& prefix, double from) {
  const std::vector<std::string> names{"height",       "speed",       "rebound",
                                       "contact_time", "energy_lost", "flattening"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    cells.insert({prefix + names[k], from + static_cast<double>(k + 1)});
  }
}

TEST(AccuracyCsv, HasEachValueInItsColumn) {
  TimedRow timed;
  timed.row.setting = {"pefrl", Contact::resolved, 77};
  timed.row.step = 0.125;
  timed.row.steps = 31;
  timed.row.evaluations = 32;
  timed.row.kernel = "ring";
  timed.row.record.observables = made_up_observables(200.0);
  timed.row.errors = {made_up_observables(300.0), 33.5, 34.5, 35.5};
  timed.row.note = "so, and \"so\"";
  timed.seconds = 36.5;
  TimedRow baseline = timed;
  baseline.row.setting.method = "gsl-rk8pd";
  baseline.row.baseline = BaselineContact::located;
  baseline.row.tolerance = 1e-9;
  CourseRecord reference;
  reference.observables = made_up_observables(400.0);
  const CourseErrors bar{made_up_observables(500.0), 37.5, 38.5, 39.5};
  const std::vector<TimedRow> all{timed, baseline};
  const auto rows = read_table(accuracy_csv(all, reference, bar));
  ASSERT_EQ(rows.size(), 3U);
  Cells first{{"method", "reference"},
              {"contact", ""},
              {"dt", ""},
              {"tolerance", ""},
              {"steps", ""},
              {"evaluations", ""},
              {"kernel", ""},
              {"seconds", ""},
              {"error_position", 37.5},
              {"error_energy", 39.5},
              {"error_energy_free", 38.5},
              {"note", ""}};
  add_observables(first, "", 400.0);
  add_observables(first, "error_", 500.0);
  expect_row(rows[0], first);
  Cells second{{"method", "pefrl"},
               {"contact", "resolved"},
               {"dt", 0.125},
               {"tolerance", ""},
               {"steps", 31.0},
               {"evaluations", 32.0},
               {"kernel", "ring"},
               {"seconds", 36.5},
               {"error_position", 33.5},
               {"error_energy", 35.5},
               {"error_energy_free", 34.5},
               {"note", "so, and \"so\""}};
  add_observables(second, "", 200.0);
  add_observables(second, "error_", 300.0);
  expect_row(rows[1], second);
  second.at("method") = "gsl-rk8pd";
  second.at("contact") = "located";
  second.at("tolerance") = 1e-9;
  expect_row(rows[2], second);
}

// ---- extremes.csv

std::vector<ExtremeEntry> made_up_entries() {
  ExtremeEntry good;
  good.row.name = "a-row";
  good.row.group = "wall";
  good.row.scene.title = "A \"title\", with a comma";
  good.row.expected = Outcome::stops;
  good.row.because = "it, must";
  good.result = {"stops", true, 3, 41, 0.625, "some | detail"};
  ExtremeEntry bad = good;
  bad.row.name = "b-row";
  bad.row.expected = Outcome::refused;
  bad.result = {"fails", false, -1, 42, std::nullopt, "other detail"};
  return {good, bad};
}

TEST(ExtremesCsv, HasEachValueInItsColumn) {
  const auto rows = read_table(extremes_csv(made_up_entries()));
  ASSERT_EQ(rows.size(), 2U);
  Cells expected{
      {"row", "a-row"},         {"group", "wall"},          {"scene", "A \"title\", with a comma"},
      {"expected", "stops"},    {"because", "it, must"},    {"happened", "stops"},
      {"as_expected", 1.0},     {"exit_code", 3.0},         {"steps", 41.0},
      {"greatest_part", 0.625}, {"detail", "some | detail"}};
  expect_row(rows[0], expected);
  expected.at("row") = "b-row";
  expected.at("expected") = "refused";
  expected.at("happened") = "fails";
  expected.at("as_expected") = 0.0;
  expected.at("exit_code") = -1.0;
  expected.at("steps") = 42.0;
  expected.at("greatest_part") = "";
  expected.at("detail") = "other detail";
  expect_row(rows[1], expected);
}

TEST(ExtremesMarkdown, CountsAndMarksTheRows) {
  const std::string text = extremes_markdown(made_up_entries(), "bounce extremes --this");
  for (const char* part : {"1 of 2 rows as expected",
                           "| a-row | A \"title\", with a comma | stops | it, must | stops: some "
                           "\\| detail | 0.625 | ok |",
                           "| b-row | A \"title\", with a comma | refused | it, must | fails: "
                           "other detail | - | **FAILED** |",
                           "Made by `bounce extremes --this`"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
  EXPECT_EQ(line_of(made_up_entries()[0]).substr(0, 12), "ok     a-row");
  EXPECT_EQ(line_of(made_up_entries()[1]).substr(0, 12), "FAILED b-row");
}

// ---- the table of bounce verify

TEST(EquivalenceTable, HasEachValueInItsColumn) {
  const std::vector<EquivalenceRow> rows{
      {"a scene", "ring", "a check", "1.00e-01", "2.00e-01", true},
      {"b scene", "csr", "b check", "3.00e-01", "4.00e-01", false}};
  std::istringstream lines(equivalence_table(rows));
  std::string head, line;
  std::getline(lines, head);
  for (const EquivalenceRow& row : rows) {
    std::getline(lines, line);
    const auto under = [&](const char* name) {
      const auto from = head.find(name);
      EXPECT_NE(from, std::string::npos) << name;
      return line.substr(from, line.find("  ", from) - from);
    };
    EXPECT_EQ(under("scene"), row.scene);
    EXPECT_EQ(line.substr(head.find("kernel"), 4), row.kernel + (row.pass ? "" : " "));
    EXPECT_EQ(under("check"), row.check);
    EXPECT_EQ(under("measured"), row.measured);
    EXPECT_EQ(under("allowed"), row.allowed);
    EXPECT_EQ(line.substr(line.rfind(' ') + 1), row.pass ? "ok" : "FAILED");
  }
  EXPECT_EQ(equivalence_verdict(rows), "NOT EQUIVALENT: 1 of 2 rows hold");
  EXPECT_FALSE(is_equivalent(rows));
  EXPECT_EQ(equivalence_verdict({rows[0]}), "equivalent: 1 of 1 rows hold");
  EXPECT_TRUE(is_equivalent({rows[0]}));
  // No row proves nothing.
  EXPECT_EQ(equivalence_verdict({}), "NOT EQUIVALENT: 0 of 0 rows hold");
  EXPECT_FALSE(is_equivalent({}));
}

}  // namespace
}  // namespace bounce
