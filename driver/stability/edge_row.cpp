#include "driver/stability/edge_row.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include <fmt/format.h>

namespace bounce {
namespace {

constexpr std::size_t key_columns = edge_key_columns;
constexpr std::size_t columns = key_columns + 13;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  for (std::size_t from = 0;;) {
    const std::size_t comma = line.find(',', from);
    fields.push_back(line.substr(from, comma - from));
    if (comma == std::string::npos) return fields;
    from = comma + 1;
  }
}

// Takes fields in turn and notices one that is no number.
class Reader {
 public:
  explicit Reader(const std::vector<std::string>& fields) : fields_(fields) {}
  const std::string& text() { return fields_[at_++]; }
  double number() {
    const std::string& field = text();
    if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
    char* end = nullptr;
    const double value = std::strtod(field.c_str(), &end);
    good_ = good_ && *end == '\0';
    return value;
  }
  template <class Value>
  Value one_of(std::initializer_list<Value> values) {
    const std::string& field = text();
    for (const Value value : values) {
      if (name_of(value) == field) return value;
    }
    good_ = false;
    return *values.begin();
  }
  void fail() { good_ = false; }
  [[nodiscard]] bool good() const { return good_; }

 private:
  const std::vector<std::string>& fields_;
  std::size_t at_ = 0;
  bool good_ = true;
};

}  // namespace

const char* const edge_header =
    "method,passage,sought,E,dt,g,speed,disturbed,growth,periods,outcome,predicted,strict,stable,"
    "unstable,flight,measured_over_predicted,part_used_at_edge,smallest_ratio,left_wall,runs,steps,"
    "seconds\n";

std::string name_of(Passage passage) { return passage == Passage::flight ? "flight" : "bounce"; }

std::string name_of(EdgeOutcome outcome) {
  switch (outcome) {
    case EdgeOutcome::found:
      return "found";
    case EdgeOutcome::always_stable:
      return "always stable";
    case EdgeOutcome::always_unstable:
      return "always unstable";
    case EdgeOutcome::refused:
      break;
  }
  return "refused";
}

std::string edge_key(const EdgeCase& what) {
  const Scene& scene = what.scene;
  const bool step = what.sought == Sought::step;
  // In flight there is no gravity.
  const double g =
      what.passage == Passage::flight ? 0.0 : std::hypot(scene.gravity.x, scene.gravity.y);
  return fmt::format("{},{},{},{},{},{},{:.6g},{},{},{}", scene.time.method, name_of(what.passage),
                     step ? "dt" : "E", step ? fmt::format("{}", scene.law.elasticity) : "",
                     step ? "" : fmt::format("{}", scene.time.step), g, what.speed,
                     what.disturbance, what.criterion.growth, what.criterion.periods);
}

std::string edge_line(const std::string& key, const Edge& edge, double seconds) {
  std::string outcome = name_of(edge.outcome);
  if (!edge.why.empty()) outcome += ": " + edge.why;
  std::replace(outcome.begin(), outcome.end(), ',', ';');
  std::replace(outcome.begin(), outcome.end(), '\n', ' ');
  const bool both = edge.stable > 0.0 && edge.predicted > 0.0;
  return fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.4g},{:.4g},{},{},{},{:.3g}",
                     key, outcome, edge.predicted, edge.strict, edge.stable, edge.unstable,
                     edge.flight, both ? fmt::format("{:.4f}", edge.stable / edge.predicted) : "",
                     edge.used, edge.ratio, edge.left ? 1 : 0, edge.runs, edge.steps, seconds);
}

std::optional<EdgeRow> read_edge_line(const std::string& line) {
  const std::vector<std::string> fields = split(line);
  if (fields.size() != columns) return std::nullopt;
  Reader read(fields);
  EdgeRow row;
  row.method = read.text();
  row.passage = read.one_of({Passage::flight, Passage::bounce});
  row.sought = read.text() == "dt" ? Sought::step : Sought::elasticity;
  row.elasticity = read.number();
  row.step = read.number();
  row.gravity = read.number();
  row.edge.speed = read.number();
  row.disturbance = read.number();
  row.criterion.growth = read.number();
  row.criterion.periods = read.number();
  if (fields[key_columns].starts_with("refused")) {
    row.edge.why = read.text();
    row.edge.outcome = EdgeOutcome::refused;
  } else {
    row.edge.outcome =
        read.one_of({EdgeOutcome::found, EdgeOutcome::always_stable, EdgeOutcome::always_unstable});
  }
  row.edge.predicted = read.number();
  row.edge.strict = read.number();
  row.edge.stable = read.number();
  row.edge.unstable = read.number();
  row.edge.flight = read.number();
  read.number();  // measured over predicted
  row.edge.used = read.number();
  row.edge.ratio = read.number();
  row.edge.left = read.number() != 0.0;
  row.edge.runs = static_cast<int>(read.number());
  row.edge.steps = static_cast<std::int64_t>(read.number());
  row.seconds = read.number();
  return read.good() ? std::optional(row) : std::nullopt;
}

}  // namespace bounce
