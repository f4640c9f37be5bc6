#include "kernels/model/ball.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "kernels/model/disc.hpp"

namespace bounce {
namespace {

// The author's 2 pi/120 and pi/120, as printed.
constexpr double listing_spacing = 0.05235987755;
constexpr double listing_stagger = 0.02617993878;
constexpr std::int64_t listing_per_ring = 120;

double angle(const BallSpec& spec, std::size_t ring, std::int64_t column) {
  const bool staggered = ring % 2 == 1;
  const auto i = static_cast<double>(column);
  if (spec.rounding == Rounding::listing && spec.per_ring == listing_per_ring) {
    return listing_spacing * i + (staggered ? listing_stagger : 0.0);
  }
  const double spacing = 2.0 * std::numbers::pi / static_cast<double>(spec.per_ring);
  return spacing * (i + (staggered ? 0.5 : 0.0));
}

}  // namespace

double four_decimals(double x) {
  // Decimal digits and back, not x * 1e4: the product would round once more before the cut.
  std::array<char, 400> digits{};
  const auto printed =
      std::to_chars(digits.data(), digits.data() + digits.size(), x, std::chars_format::fixed, 4);
  double read = 0.0;
  std::from_chars(digits.data(), printed.ptr, read);
  return read + 0.0;  // -0.0000 reads as zero
}

double as_printed(Rounding rounding, double x) {
  return rounding == Rounding::listing ? four_decimals(x) : x;
}

State make_ball(const BallSpec& spec) {
  if (spec.kind == BallKind::disc) return make_disc(spec);
  const auto n = static_cast<std::size_t>(spec.per_ring);
  State state(spec.radii.size() * n);
  const auto format = [&spec](double x) { return as_printed(spec.rounding, x); };
  const double vx = format(spec.velocity.x);
  const double vy = format(spec.velocity.y);
  for (std::size_t ring = 0; ring < spec.radii.size(); ++ring) {
    for (std::size_t column = 0; column < n; ++column) {
      const double theta = angle(spec, ring, static_cast<std::int64_t>(column));
      const std::size_t i = ring * n + column;
      state.x[i] = format(spec.centre.x + spec.radii[ring] * std::cos(theta));
      state.y[i] = format(spec.centre.y + spec.radii[ring] * std::sin(theta));
      state.vx[i] = vx;
      state.vy[i] = vy;
    }
  }
  return state;
}

Neighbours ball_neighbours(const BallSpec& spec) {
  if (spec.kind == BallKind::rings) {
    return Neighbours::of_rings(static_cast<int>(spec.radii.size()), spec.per_ring);
  }
  BondList bonds = disc_bonds(DiscRows(spec.radii.front(), spec.spacing.value()));
  check_bonds(bonds);
  return bonds;
}

BallSize ball_size(const BallSpec& spec) {
  if (spec.kind == BallKind::disc) {
    const DiscRows rows(spec.radii.front(), spec.spacing.value());
    const auto particles = static_cast<std::size_t>(rows.particles());
    const auto entries = static_cast<std::size_t>(2 * rows.bonds());
    return {particles, entries, bond_list_bytes(particles, entries)};
  }
  const auto rings = static_cast<int>(spec.radii.size());
  return {static_cast<std::size_t>(rings * spec.per_ring), ring_entries(rings, spec.per_ring), 0};
}

std::vector<double> rest_lengths_squared(const BallSpec& spec, Rest rest) {
  if (rest == Rest::listing) {
    // The listing's constants, 1096.64, 16328, 1578.4, 16462.8 and 2148.8, over its E = 16000.
    return {0.06854, 1.0205, 0.09865, 1.028925, 0.1343};
  }
  if (spec.kind == BallKind::disc) return {*spec.spacing * *spec.spacing};
  // In extended precision, so that each square is the double nearest to the exact geometry's.
  const long double half_spacing =
      std::numbers::pi_v<long double> / static_cast<long double>(spec.per_ring);
  std::vector<double> squares;
  for (std::size_t ring = 0; ring < spec.radii.size(); ++ring) {
    const long double r = spec.radii[ring];
    const long double chord = 2.0L * r * std::sin(half_spacing);
    squares.push_back(static_cast<double>(chord * chord));
    if (ring + 1 == spec.radii.size()) break;
    // (R - r)^2 + 4 r R sin^2(half/2): the law of cosines without its cancellation.
    const long double outer = spec.radii[ring + 1];
    const long double s = std::sin(half_spacing / 2.0L);
    squares.push_back(static_cast<double>((outer - r) * (outer - r) + 4.0L * r * outer * s * s));
  }
  return squares;
}

}  // namespace bounce
