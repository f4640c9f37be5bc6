#include "verify/stability/trouble_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "verify/vibrations/spectrum.hpp"
#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The class of the bond between two particles; nothing if there is none.
std::optional<std::size_t> class_between(const BondList& bonds, std::int64_t first,
                                         std::int64_t second) {
  if (first < 0 || second < 0) return std::nullopt;
  const auto i = static_cast<std::size_t>(first);
  for (auto e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
    const auto entry = static_cast<std::size_t>(e);
    if (bonds.neighbour[entry] == second) return bonds.bond_class[entry];
  }
  return std::nullopt;
}

// Ring r has class 2r, rings r and r+1 have class 2r+1; rings are named from 1.
std::string name_of_class(std::size_t bond_class) {
  return "ring " + std::to_string(bond_class / 2 + 1) + "-ring " +
         std::to_string((bond_class + 1) / 2 + 1);
}

TroubledState look_at(const Problem& problem, const Trouble& trouble,
                      std::optional<std::size_t> bond_class, const State& state) {
  TroubledState seen;
  seen.energy = measure(problem, state).total();
  seen.ratio = nan;
  if (bond_class) {
    const auto i = static_cast<std::size_t>(trouble.bond_first);
    const auto j = static_cast<std::size_t>(trouble.bond_second);
    seen.ratio = std::hypot(state.x[i] - state.x[j], state.y[i] - state.y[j]) /
                 problem.classes[*bond_class].rest;
  }
  if (const auto fastest = fastest_vibration(problem, state)) {
    seen.edge = EdgeDistance{part_of_stable_step(problem, fastest->omega),
                             stable_step(*problem.method, fastest->omega)};
  }
  return seen;
}

// The decimal number with two digits not above the value, but for rounding, as it would be typed.
double two_digits_down(double value) {
  value *= 1.0 + 1e-12;  // two digits already stay as they are
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1e", std::floor(value / unit) * unit);
  return std::strtod(text.data(), nullptr);
}

}  // namespace

double TroubleReport::energy_jump() const { return before ? refused.energy - before->energy : nan; }

TroubleReport report_trouble(const Problem& problem, const Trouble& trouble, const State* before,
                             const State& refused, const std::optional<Margin>& margin) {
  TroubleReport report;
  const auto bond_class = class_between(problem.bonds, trouble.bond_first, trouble.bond_second);
  if (bond_class) report.bond_class = name_of_class(*bond_class);
  report.refused = look_at(problem, trouble, bond_class, refused);
  double smallest = std::numeric_limits<double>::infinity();
  if (margin && margin->part > 0.0) smallest = problem.step / margin->part;
  if (before != nullptr) {
    report.before = look_at(problem, trouble, bond_class, *before);
    if (report.before->edge) smallest = std::min(smallest, report.before->edge->stable_step);
  }
  if (smallest > 0.0 && std::isfinite(smallest)) {
    report.stable_step = two_digits_down(std::min(step_safety * smallest, 0.5 * problem.step));
  }
  return report;
}

}  // namespace bounce
