#include "driver/extremes/extreme_row.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>

#include "driver/scene/built_in_scenes.hpp"
#include "kernels/model/problem.hpp"

namespace bounce {
namespace {

// In this order the table shows them.
constexpr std::array<std::string_view, 9> groups{"elasticity", "impact", "gravity", "law",   "size",
                                                 "bond",       "wall",   "edge",    "offset"};

struct Reader {
  const std::string& name;

  [[noreturn]] void refuse(const std::string& key, const std::string& allowed) const {
    throw InputError(fmt::format("extremes/{}: extreme.{}: allowed is {}", name, key, allowed));
  }
  template <class T>
  void take(const std::string& key, const toml::node& node, const char* allowed, T& value) const {
    // A whole number is a number, too; but not a truth.
    const auto found = std::is_same_v<T, double> ? node.value<T>() : node.value_exact<T>();
    if (!found) refuse(key, allowed);
    value = *found;
  }
  [[nodiscard]] Outcome outcome(const toml::node& node) const {
    for (const Outcome each : {Outcome::complete, Outcome::refused, Outcome::stops}) {
      if (node.value_exact<std::string>() == name_of(each)) return each;
    }
    refuse("expect", "\"complete\", \"refused\" or \"stops\"");
  }
  void entry(const std::string& key, const toml::node& node, ExtremeRow& row) const {
    if (key == "group") return take(key, node, "text", row.group);
    if (key == "because") return take(key, node, "text", row.because);
    if (key == "says") return take(key, node, "text", row.says);
    if (key == "like") return take(key, node, "the name of another row", row.like);
    if (key == "quick") return take(key, node, "true or false", row.quick);
    if (key == "force") return take(key, node, "true or false", row.force);
    if (key == "booked") return take(key, node, "a number of steps", row.booked);
    if (key == "first_bond") return take(key, node, "R/R0, as in 1e-3", row.first_bond.emplace());
    if (key != "expect") {
      refuse(key, "group, expect, because, says, like, quick, force, booked, first_bond");
    }
    row.expected = outcome(node);
  }
};

std::size_t rank(const std::string& group) {
  return static_cast<std::size_t>(std::find(groups.begin(), groups.end(), group) - groups.begin());
}

}  // namespace

std::string name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::complete:
      return "complete";
    case Outcome::refused:
      return "refused";
    case Outcome::stops:
      break;
  }
  return "stops";
}

ExtremeRow read_extreme_row(const std::string& name, std::string_view text) {
  ExtremeRow row;
  row.name = name;
  row.text = text;
  row.scene = SceneFile::parse(text, "extremes/" + name).scene();
  const Reader reader{row.name};
  const toml::table file = toml::parse(text);
  const toml::table* table = file["extreme"].as_table();
  if (table == nullptr || !table->contains("expect")) {
    reader.refuse("expect", "\"complete\", \"refused\" or \"stops\": it has to be given");
  }
  for (const auto& [key, node] : *table) reader.entry(std::string(key.str()), node, row);
  if (rank(row.group) == groups.size()) {
    reader.refuse("group", fmt::format("one of {}", fmt::join(groups, ", ")));
  }
  if (row.because.empty()) reader.refuse("because", "a reason");
  if (row.booked < 0) reader.refuse("booked", "0 or more");
  if (row.first_bond && !(*row.first_bond > 0.0 && std::isfinite(*row.first_bond))) {
    reader.refuse("first_bond", "a finite number above 0");
  }
  return row;
}

std::vector<ExtremeRow> extreme_rows() {
  std::vector<ExtremeRow> rows;
  for (const BuiltInScene& scene : extreme_scenes()) {
    rows.push_back(read_extreme_row(std::string(scene.name), scene.text));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const ExtremeRow& a, const ExtremeRow& b) {
    return rank(a.group) < rank(b.group);
  });
  return rows;
}

std::optional<State> start_of(const ExtremeRow& row) {
  if (!row.first_bond) return std::nullopt;
  const Problem problem = make_problem(row.scene);
  State state = problem.initial;
  double rest = 0.0;  // of bond 1-2
  problem.bonds.visit_row(0, [&](std::size_t neighbour, std::size_t bond_class) {
    if (neighbour == 1) rest = problem.classes[bond_class].rest;
  });
  const double dx = state.x[0] - state.x[1];
  const double dy = state.y[0] - state.y[1];
  const double scale = *row.first_bond * rest / std::hypot(dx, dy);
  state.x[0] = state.x[1] + scale * dx;
  state.y[0] = state.y[1] + scale * dy;
  return state;
}

}  // namespace bounce
