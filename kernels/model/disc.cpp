#include "kernels/model/disc.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "kernels/model/ball.hpp"

namespace bounce {
namespace {

// A neighbour, as rows and half spacings away.
struct Offset {
  std::int64_t rows, places;
};
constexpr std::array<Offset, 6> neighbours{{{0, 2}, {0, -2}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

// The outermost place of row j within the circle, whose square is in half spacings; less than 0 or
// 1 (by parity): the row is empty.
std::int64_t outermost(double radius_squared, std::int64_t j) {
  const auto rows = static_cast<double>(j);
  const double rest = radius_squared - 3.0 * rows * rows;
  if (rest < 0.0) return -1;
  auto reach = static_cast<std::int64_t>(std::sqrt(rest));
  while (static_cast<double>((reach + 1) * (reach + 1)) <= rest) ++reach;
  while (reach >= 0 && static_cast<double>(reach * reach) > rest) --reach;
  return (reach - j) % 2 == 0 ? reach : reach - 1;
}

}  // namespace

DiscRows::DiscRows(double radius, double spacing) {
  // A rim particle that the division rounds out of the circle is let in again.
  constexpr double slack = 1.0 + 1e-12;
  const double in_half_spacings = 2.0 * radius / spacing;
  const double squared = in_half_spacings * in_half_spacings * slack;
  std::vector<std::int64_t> reaches;
  for (std::int64_t j = 0; outermost(squared, j) >= 0; ++j) {
    reaches.push_back(outermost(squared, j));
  }
  last_ = static_cast<std::int64_t>(reaches.size()) - 1;
  for (std::int64_t j = -last_; j <= last_; ++j) {
    const std::int64_t reach = reaches[static_cast<std::size_t>(std::abs(j))];
    rows_.push_back({reach, particles_});
    particles_ += reach + 1;
  }
}

bool DiscRows::holds(std::int64_t j, std::int64_t place) const {
  return std::abs(j) <= last_ && std::abs(place) <= reach(j) && (place - j) % 2 == 0;
}

std::int64_t DiscRows::particle(std::int64_t j, std::int64_t place) const {
  return row(j).first + (place + row(j).reach) / 2;
}

std::int64_t DiscRows::bonds() const {
  std::int64_t bonds = 0;
  for (std::int64_t j = -last_; j <= last_; ++j) {
    bonds += reach(j);
    // Of two rows the reaches differ: each particle of the shorter one has two in the longer.
    if (j < last_) bonds += 2 * (std::min(reach(j), reach(j + 1)) + 1);
  }
  return bonds;
}

State make_disc(const BallSpec& spec) {
  const double spacing = spec.spacing.value();
  const DiscRows rows(spec.radii.front(), spacing);
  const double row_height = 0.5 * std::numbers::sqrt3 * spacing;
  State state(static_cast<std::size_t>(rows.particles()));
  std::size_t i = 0;
  for (std::int64_t j = -rows.last(); j <= rows.last(); ++j) {
    for (std::int64_t place = -rows.reach(j); place <= rows.reach(j); place += 2, ++i) {
      state.x[i] =
          as_printed(spec.rounding, spec.centre.x + 0.5 * spacing * static_cast<double>(place));
      state.y[i] = as_printed(spec.rounding, spec.centre.y + row_height * static_cast<double>(j));
      state.vx[i] = as_printed(spec.rounding, spec.velocity.x);
      state.vy[i] = as_printed(spec.rounding, spec.velocity.y);
    }
  }
  return state;
}

BondList disc_bonds(const DiscRows& rows) {
  BondList bonds;
  const auto entries = static_cast<std::size_t>(2 * rows.bonds());
  bonds.start.reserve(static_cast<std::size_t>(rows.particles()) + 1);
  bonds.neighbour.reserve(entries);
  bonds.bond_class.assign(entries, 0);
  bonds.start.push_back(0);
  for (std::int64_t j = -rows.last(); j <= rows.last(); ++j) {
    for (std::int64_t place = -rows.reach(j); place <= rows.reach(j); place += 2) {
      for (const Offset& to : neighbours) {
        if (!rows.holds(j + to.rows, place + to.places)) continue;
        bonds.neighbour.push_back(
            static_cast<std::int32_t>(rows.particle(j + to.rows, place + to.places)));
      }
      bonds.start.push_back(static_cast<std::int64_t>(bonds.neighbour.size()));
    }
  }
  return bonds;
}

}  // namespace bounce
