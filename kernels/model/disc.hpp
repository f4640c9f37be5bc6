// A filled disc on a triangular lattice: the ball without a hollow, for csr.
//
// Rows of particles, `spacing` apart, every other one shifted by half of it; one particle stands in
// the centre. Numbered row by row upwards, in a row from left to right:
//
//       5 - 6           six neighbours inside, fewer at the rim; all bonds are of one class
//      / \ / \          and `spacing` long
//     2 - 3 - 4
//      \ / \ /
//       0 - 1
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/model/bonds.hpp"
#include "kernels/model/scene.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// The lattice points within a circle round one of them. Places are counted in half spacings along
/// a row, from the centre; those of row j (0 in the middle) have j's parity.
class DiscRows {
 public:
  /// `radius` and `spacing` in cm, above 0.
  DiscRows(double radius, double spacing);

  /// Rows -last() to last().
  [[nodiscard]] std::int64_t last() const { return last_; }
  /// The outermost place of row j: it holds the places -reach(j), -reach(j) + 2, ... reach(j).
  [[nodiscard]] std::int64_t reach(std::int64_t j) const { return row(j).reach; }
  [[nodiscard]] bool holds(std::int64_t j, std::int64_t place) const;
  /// Index of the particle at a place that row j holds.
  [[nodiscard]] std::int64_t particle(std::int64_t j, std::int64_t place) const;
  [[nodiscard]] std::int64_t particles() const { return particles_; }
  [[nodiscard]] std::int64_t bonds() const;

 private:
  struct Row {
    std::int64_t reach;
    std::int64_t first;  // index of the particle at -reach
  };
  [[nodiscard]] const Row& row(std::int64_t j) const {
    return rows_[static_cast<std::size_t>(j + last_)];
  }

  std::vector<Row> rows_;
  std::int64_t last_ = 0;
  std::int64_t particles_ = 0;
};

/// Particles of a valid spec of kind disc.
State make_disc(const BallSpec& spec);

/// Its bonds, all of class 0. A row: right, left, then the row above and the row below, each right
/// before left.
BondList disc_bonds(const DiscRows& rows);

}  // namespace bounce
