#include "driver/stability/edge_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

namespace bounce {
namespace {

constexpr double unmoved = 0.98;       // of free flight's edge; bounces nearer are only counted
constexpr double allowed_move = 0.02;  // of an edge when the criterion changes

bool same(const EdgeCriterion& a, const EdgeCriterion& b) {
  return a.growth == b.growth && a.periods == b.periods;
}

// Of an edge not found, what was.
std::string measured(const Edge& edge) {
  switch (edge.outcome) {
    case EdgeOutcome::found:
      return fmt::format("{:.4g}", edge.stable);
    case EdgeOutcome::always_stable:
      return fmt::format("> {:.3g}", edge.stable);
    case EdgeOutcome::always_unstable:
      return fmt::format("< {:.3g}", edge.unstable);
    case EdgeOutcome::refused:
      break;
  }
  return edge.why;
}

std::string over(double a, double b) {
  return a > 0.0 && b > 0.0 ? fmt::format("{:.3f}", a / b) : "-";
}

class Table {
 public:
  Table(std::span<const EdgeRow> rows, double elasticity, const EdgeCriterion& criterion)
      : rows_(rows), elasticity_(elasticity), criterion_(criterion) {
    for (const EdgeRow& row : rows) {
      if (std::find(methods_.begin(), methods_.end(), row.method) == methods_.end()) {
        methods_.push_back(row.method);
      }
    }
  }
  std::string text() {
    how();
    flights();
    strict_limits();
    disturbances();
    largest_elasticity();
    bounces();
    criteria();
    return text_;
  }

 private:
  template <class Wanted>
  [[nodiscard]] std::vector<const EdgeRow*> rows(const Wanted& wanted) const {
    std::vector<const EdgeRow*> found;
    for (const EdgeRow& row : rows_) {
      if (wanted(row)) found.push_back(&row);
    }
    return found;
  }

  void how() {
    text_ += fmt::format(
        "Unstable: energy gained, more than {:g} times what the ball had, within {:g} periods of "
        "its\nfastest vibration (of a bounce: within the bounce), or a state that is not finite.\n"
        "Edge: between a stable and an unstable run at most 1 % apart; printed is the stable "
        "one.\nFree flight: no walls, no gravity, at rest. All starts are disturbed by {:g} of the "
        "shortest bond.\n",
        criterion_.growth, criterion_.periods, edge_disturbance);
  }

  [[nodiscard]] bool usual(const EdgeRow& row) const {
    return same(row.criterion, criterion_) && row.disturbance == edge_disturbance;
  }

  // Neither the criterion nor a tenth or ten times of it.
  [[nodiscard]] bool longer(const EdgeRow& row) const {
    return row.disturbance == edge_disturbance && row.criterion.growth == criterion_.growth &&
           row.criterion.periods > criterion_.periods &&
           row.criterion.periods != 10.0 * criterion_.periods;
  }

  void disturbances() {
    const auto found =
        rows([&](const EdgeRow& row) { return row.disturbance != edge_disturbance; });
    if (found.empty()) return;
    text_ += fmt::format(
        "\nFree flight at E = {:g}, disturbed more, {:g} periods: over the edge predicted\nfrom "
        "the disturbed start, and over that of the ball at rest\n"
        "{:<14} {:>14} {:>12} {:>20} {:>12}\n",
        elasticity_, found.front()->criterion.periods, "method", "shortest bonds", "dt, s",
        "measured/predicted", "meas./rest");
    for (const EdgeRow* row : found) {
      const EdgeRow* rest = beside(*row);
      text_ += fmt::format("{:<14} {:>14g} {:>12} {:>20} {:>12}\n", row->method, row->disturbance,
                           measured(row->edge), over(row->edge.stable, row->edge.predicted),
                           rest == nullptr ? "-" : over(row->edge.stable, rest->edge.predicted));
    }
  }

  // Largest and least of a ratio.
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    bool whole = true;  // no ratio was a NaN
    void add(double value) {
      whole = whole && value > 0.0;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    [[nodiscard]] std::string text() const {
      return whole ? fmt::format("{:.3f} ... {:.3f}", low, high) : "-";
    }
  };

  void flights() {
    text_ += fmt::format(
        "\nFree flight: largest stable step, over that predicted for the criterion and that at "
        "which the\nfirst vibration grows, however slowly (strict)\n"
        "{:<14} {:>5} {:>16} {:>11} {:>11} {:>18} {:>18}\n",
        "method", "cases", "E", "dt sqrt(E)", "strict", "measured/predicted", "measured/strict");
    for (const std::string& method : methods_) {
      const auto found = rows([&](const EdgeRow& row) {
        return row.method == method && row.passage == Passage::flight &&
               row.sought == Sought::step && usual(row);
      });
      Range predicted, strict, e;
      double product = 0.0, strict_product = 0.0;
      const auto n = static_cast<double>(found.size());
      for (const EdgeRow* row : found) {
        predicted.add(row->edge.stable / row->edge.predicted);
        strict.add(row->edge.stable / row->edge.strict);
        e.add(row->elasticity);
        product += row->edge.stable * std::sqrt(row->elasticity) / n;
        strict_product += row->edge.strict * std::sqrt(row->elasticity) / n;
      }
      text_ += fmt::format("{:<14} {:>5} {:>16} {:>11.5g} {:>11.5g} {:>18} {:>18}\n", method,
                           found.size(), fmt::format("{:g} ... {:g}", e.low, e.high), product,
                           strict_product, predicted.text(), strict.text());
    }
  }

  void strict_limits() {
    const auto found = rows([&](const EdgeRow& row) { return longer(row); });
    if (found.empty()) return;
    text_ += fmt::format(
        "\nThe strict limit at E = {:g}, where flights of {:g} periods pass over it: so long "
        "that the\nfirst unstable window shows, climbing through it\n"
        "{:<14} {:>8} {:>12} {:>12} {:>12} {:>20}\n",
        elasticity_, criterion_.periods, "method", "periods", "strict, s", "dt, s", "unstable, s",
        "measured/strict");
    for (const EdgeRow* row : found) {
      text_ += fmt::format("{:<14} {:>8g} {:>12.6g} {:>12} {:>12.6g} {:>20}\n", row->method,
                           row->criterion.periods, row->edge.strict, measured(row->edge),
                           row->edge.unstable, over(row->edge.stable, row->edge.strict));
    }
  }

  void largest_elasticity() {
    const auto found =
        rows([&](const EdgeRow& row) { return row.sought == Sought::elasticity && usual(row); });
    if (found.empty()) return;
    text_ += fmt::format("\nLargest stable E at dt = {:g} s\n{:<14} {:<8} {:>12} {:>12} {:>20}\n",
                         found.front()->step, "method", "passage", "predicted", "measured",
                         "measured/predicted");
    for (const EdgeRow* row : found) {
      text_ += fmt::format("{:<14} {:<8} {:>12.4g} {:>12} {:>20}\n", row->method,
                           name_of(row->passage), row->edge.predicted, measured(row->edge),
                           over(row->edge.stable, row->edge.predicted));
    }
  }

  void bounces() {
    const auto found = rows([&](const EdgeRow& row) {
      return row.passage == Passage::bounce && row.sought == Sought::step && usual(row);
    });
    if (found.empty()) return;
    text_ += fmt::format(
        "\nThrough a bounce: largest stable step, its part of free flight's, the stiffest bond, "
        "and the\npart of the stable step that the bounce used at its worst at this edge\n"
        "{:<14} {:>9} {:>8} {:>8} {:>12} {:>12} {:>10} {:>11} {:>7} {:>7}\n",
        "method", "E", "cm/s", "g", "dt, s", "pred./flight", "meas./fl.", "meas./pred.", "R/R0",
        "used");
    std::vector<std::size_t> left_out(methods_.size(), 0);
    for (const EdgeRow* row : found) {
      const Edge& edge = row->edge;
      if (edge.outcome == EdgeOutcome::found && edge.stable > unmoved * edge.flight) {
        ++left_out[method_number(*row)];
        continue;
      }
      text_ += fmt::format(
          "{:<14} {:>9.4g} {:>8.3g} {:>8.3g} {:>12} {:>12} {:>10} {:>11} {:>7.3f} "
          "{:>7.3f}{}\n",
          row->method, row->elasticity, edge.speed, row->gravity, measured(edge),
          over(edge.predicted, edge.flight), over(edge.stable, edge.flight),
          over(edge.stable, edge.predicted), edge.ratio, edge.used,
          edge.left ? "" : "  stays down");
    }
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      text_ += fmt::format("{:<14} {} more, all within {:g} % of the edge of free flight\n",
                           methods_[m], left_out[m], 100.0 * (1.0 - unmoved));
    }
  }

  [[nodiscard]] std::size_t method_number(const EdgeRow& row) const {
    return static_cast<std::size_t>(std::find(methods_.begin(), methods_.end(), row.method) -
                                    methods_.begin());
  }

  // The row of another criterion beside the one that is the same in all else.
  [[nodiscard]] const EdgeRow* beside(const EdgeRow& other) const {
    const auto found = rows([&](const EdgeRow& row) {
      return row.method == other.method && row.passage == other.passage &&
             row.sought == other.sought && row.elasticity == other.elasticity &&
             row.gravity == other.gravity && row.edge.speed == other.edge.speed && usual(row);
    });
    return found.empty() ? nullptr : found.front();
  }

  void criteria() {
    const auto found = rows([&](const EdgeRow& row) {
      return !same(row.criterion, criterion_) && row.disturbance == edge_disturbance &&
             !longer(row);
    });
    if (found.empty()) return;
    text_ += fmt::format(
        "\nThe edge at E = {:g} by other criteria\n"
        "{:<14} {:<8} {:>8} {:>8} {:>12} {:>20} {:>10}\n",
        elasticity_, "method", "passage", "growth", "periods", "dt, s", "measured/predicted",
        "moves by");
    for (const EdgeRow* row : found) {
      const EdgeRow* usual = beside(*row);
      const double move = usual == nullptr ? std::numeric_limits<double>::quiet_NaN()
                                           : row->edge.stable / usual->edge.stable - 1.0;
      text_ += fmt::format("{:<14} {:<8} {:>8g} {:>8g} {:>12} {:>20} {:>8.2f} %{}\n", row->method,
                           name_of(row->passage), row->criterion.growth, row->criterion.periods,
                           measured(row->edge), over(row->edge.stable, row->edge.predicted),
                           100.0 * move,
                           std::abs(move) < allowed_move ? "" : "  DEPENDS on the criterion");
    }
  }

  std::span<const EdgeRow> rows_;
  double elasticity_;
  EdgeCriterion criterion_;
  std::vector<std::string> methods_;
  std::string text_;
};

}  // namespace

std::string edge_table(std::span<const EdgeRow> rows, double scene_elasticity,
                       const EdgeCriterion& criterion) {
  return Table(rows, scene_elasticity, criterion).text();
}

}  // namespace bounce
