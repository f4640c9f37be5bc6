#include "kernels/stepping/free_flight.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/stepping/method.hpp"

namespace bounce {
namespace {

constexpr double shortest = 1e-12, longest = 1e12;  // bonds, cm
constexpr double a_rounding = 1e-15;                // of a number stored or added
constexpr double force_rounding = 1e-12, distance_rounding = 1e-14, bound_rounding = 1e-9;

double length(Vec2 v) { return std::hypot(v.x, v.y); }

// R*/R0, where S' = 0: (R/R0)^(q-p) = q (q+1) / (p (p+1)).
double steepest_place(PairLaw law) {
  const double ratio = law.q * (law.q + 1.0) / (law.p * (law.p + 1.0));
  return std::pow(ratio, 1.0 / (law.q - law.p));
}

}  // namespace

FreeFlight::FreeFlight(const Model& model) : law_(model.law), gravity_(length(model.gravity)) {
  for (const BondClass& bond : model.classes) {
    // (R0, as G and H have it: the listing's constants are rounded one by one.)
    const double rest = std::pow(bond.repulsion / bond.attraction, 1.0 / (law_.q - law_.p));
    const double far = steepest_place(law_) * rest;
    Bond known{.law = bond};
    known.law.rest = rest;
    known.at_rest = std::abs(force_over_distance(law_, bond, rest * rest)) * rest;
    known.steepest = -stiffness(law_, bond, far * far).along;
    classes_.push_back(known);
  }
  for (const Wall& wall : model.walls) {
    farthest_offset_ = std::max(farthest_offset_, std::abs(wall.offset));
  }
  for (const Stage& stage : model.method->stages) {
    kicks_ += std::abs(stage.kick * model.step);
    drifts_ += std::abs(stage.drift * model.step);
  }
  stages_ = static_cast<double>(model.method->stages.size());
  find_kinds(model.bonds);
}

void FreeFlight::find_kinds(const Neighbours& bonds) {
  Kind kind;
  std::size_t last = 0;  // neighbours are mostly of the same kind
  for (std::size_t i = 0; i < bonds.particles(); ++i) {
    kind.clear();
    bonds.visit_row(i,
                    [&kind](std::size_t, std::size_t bond_class) { kind.push_back(bond_class); });
    std::sort(kind.begin(), kind.end());
    if (last < kinds_.size() && kinds_[last] == kind) continue;
    last = static_cast<std::size_t>(std::find(kinds_.begin(), kinds_.end(), kind) - kinds_.begin());
    if (last < kinds_.size()) continue;
    kinds_.push_back(kind);
    longest_row_ = std::max(longest_row_, static_cast<double>(kind.size()));
  }
}

FreeFlight::Rates FreeFlight::rates(const FlightSurvey& survey, double most) const {
  // Of each class: K, and the most that its bonds pull or push at the start.
  std::vector<double> stiff(classes_.size()), force(classes_.size());
  for (std::size_t c = 0; c < classes_.size(); ++c) {
    const Bond& bond = classes_[c];
    const double rest = bond.law.rest;
    const double least = std::sqrt(survey.r2[c].least), greatest = std::sqrt(survey.r2[c].greatest);
    const double r = std::min(least - 2.0 * most, rest);
    const double strain = std::max({rest - least, greatest - rest, 0.0}) + force_rounding * rest;
    stiff[c] = std::max(stiffness(law_, bond.law, r * r).along, bond.steepest);
    const double both = r * (force_over_distance(law_, {0.0, bond.law.repulsion, rest}, r * r) -
                             force_over_distance(law_, {bond.law.attraction, 0.0, rest}, r * r));
    force[c] = bond.at_rest + stiff[c] * strain + force_rounding * both;
  }
  double a = 0.0, k = 0.0;
  for (const Kind& kind : kinds_) {
    double kind_a = 0.0, kind_k = 0.0;
    for (const std::size_t c : kind) {
      kind_a += force[c];
      kind_k += 2.0 * stiff[c];
    }
    a = std::max(a, kind_a);
    k = std::max(k, kind_k);
  }
  return {a / k, std::sqrt(drifts_ / (kicks_ * k)), std::sqrt(kicks_ * drifts_ * k)};
}

FreeFlight::Window FreeFlight::window(const FlightSurvey& survey) const {
  if (!survey.finite) return {};
  double least = longest;
  for (const Span& r2 : survey.r2) {
    if (!(r2.least >= shortest * shortest && r2.greatest <= longest * longest)) return {};
    least = std::min(least, std::sqrt(r2.least));
  }
  // A wall farther off than this tells no more, and in the window no coordinate exceeds `reach`.
  const double gap = std::min(survey.gap, survey.reach);
  const double reach = survey.reach + gap;
  const double room = gap - distance_rounding * (2.0 * reach + farthest_offset_);
  if (!(room > 0.0)) return {};
  const double most = std::min(0.25 / (law_.q + 1.0) * least, 0.5 * room);

  const Rates rate = rates(survey, most);
  if (!(rate.t < 0.5) || !(rate.h > 0.0)) return {};
  const Vec2 common{0.5 * (survey.vx.least + survey.vx.greatest),
                    0.5 * (survey.vy.least + survey.vy.greatest)};
  const double speed = length(common);
  const double own = length({survey.vx.greatest - common.x, survey.vy.greatest - common.y});
  const double position_rounding = stages_ * a_rounding * reach;

  const auto holds = [&](double n, double grown, double shrunk) {
    const double common_speed = speed + n * kicks_ * gravity_;
    const double velocity_rounding = stages_ * (longest_row_ + 2.0) * a_rounding *
                                     (rate.h * (common_speed + own) + 2.0 * (most + rate.a_over_k));
    const double q = rate.a_over_k + n * position_rounding;
    const double hy =
        rate.h * own * (1.0 + bound_rounding) + a_rounding * rate.h * speed + n * velocity_rounding;
    const double q_n =
        0.5 * ((q + hy) * grown + (q - hy) * shrunk) + bound_rounding * (q + hy) * grown;
    return q_n - rate.a_over_k <= most &&
           n * drifts_ * common_speed * (1.0 + bound_rounding) + most < room;
  };
  double grown = 1.0 / (1.0 - rate.t), shrunk = 1.0 / (1.0 + rate.t);
  for (std::int64_t n = 1; n < fewest_steps; n *= 2) {
    grown *= grown;
    shrunk *= shrunk;
  }
  if (!holds(static_cast<double>(fewest_steps), grown, shrunk)) return {};
  std::int64_t n = fewest_steps;
  double half_grown = 0.0, half_shrunk = 0.0;
  while (n < most_steps && holds(2.0 * static_cast<double>(n), grown * grown, shrunk * shrunk)) {
    half_grown = grown;
    half_shrunk = shrunk;
    grown *= grown;
    shrunk *= shrunk;
    n *= 2;
  }
  // Doubling is coarse: half as much more?
  const bool more = n > fewest_steps && n < most_steps &&
                    holds(1.5 * static_cast<double>(n), grown * half_grown, shrunk * half_shrunk);
  return {more ? n + n / 2 : n, most};
}

}  // namespace bounce
