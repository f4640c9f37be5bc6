#include "kernels/csr/slices.hpp"

#include <algorithm>
#include <map>

namespace bounce {
namespace {

// Neighbours and classes of one neighbour position, lane by lane.
struct Position {
  std::vector<std::int64_t> neighbours;
  std::vector<int> classes;
};

// The rows of a slice's particles; behind the last particle they are empty.
using Rows = std::vector<std::vector<BondEntry>>;

void read_rows(const Neighbours& bonds, std::size_t first, Rows& rows) {
  for (std::size_t l = 0; l < rows.size(); ++l) {
    rows[l].clear();
    if (first + l >= bonds.particles()) continue;
    bonds.visit_row(first + l, [&row = rows[l]](std::size_t j, std::size_t bond_class) {
      row.push_back({static_cast<std::int64_t>(j), static_cast<int>(bond_class)});
    });
  }
}

void gather_position(const Rows& rows, std::size_t first, std::size_t k, Position& position) {
  position.neighbours.clear();
  position.classes.clear();
  for (std::size_t l = 0; l < rows.size(); ++l) {
    const auto self = static_cast<std::int64_t>(first + l);
    const BondEntry entry = k < rows[l].size() ? rows[l][k] : BondEntry{self, no_bond};
    position.neighbours.push_back(entry.neighbour);
    position.classes.push_back(entry.bond_class);
  }
}

std::size_t count_entries(const Neighbours& bonds, std::size_t width) {
  std::size_t entries = 0;
  std::size_t longest = 0;  // of this slice
  for (std::size_t i = 0; i < bonds.particles(); ++i) {
    longest = std::max(longest, bonds.row_length(i));
    if ((i + 1) % width != 0 && i + 1 < bonds.particles()) continue;
    entries += longest;
    longest = 0;
  }
  return entries;
}

bool consecutive(const std::vector<std::int64_t>& values) {
  for (std::size_t l = 1; l < values.size(); ++l) {
    if (values[l] != values[0] + static_cast<std::int64_t>(l)) return false;
  }
  return true;
}

}  // namespace

SlicedBonds slice_bonds(const Neighbours& bonds, int lanes) {
  SlicedBonds sliced;
  sliced.lanes = lanes;
  std::map<std::vector<int>, std::int32_t> known;
  const auto width = static_cast<std::size_t>(lanes);
  Rows rows(width);
  Position position;
  sliced.slices.reserve((bonds.particles() + width - 1) / width);
  sliced.entries.reserve(count_entries(bonds, width));
  for (std::size_t first = 0; first < bonds.particles(); first += width) {
    Slice slice{.begin = static_cast<std::int64_t>(sliced.entries.size()), .full = INT32_MAX};
    read_rows(bonds, first, rows);
    for (const auto& row : rows) {
      const auto neighbours = static_cast<std::int32_t>(row.size());
      slice.full = std::min(slice.full, neighbours);
      slice.all = std::max(slice.all, neighbours);
    }
    for (std::int32_t k = 0; k < slice.all; ++k) {
      gather_position(rows, first, static_cast<std::size_t>(k), position);
      const auto next = static_cast<std::int32_t>(known.size());
      const auto [row, is_new] = known.try_emplace(position.classes, next);
      if (is_new) {
        sliced.combinations.insert(sliced.combinations.end(), position.classes.begin(),
                                   position.classes.end());
      }
      auto place = static_cast<std::int32_t>(position.neighbours[0]);
      if (!consecutive(position.neighbours)) {
        place = -1 - static_cast<std::int32_t>(sliced.scattered.size() / width);
        sliced.scattered.insert(sliced.scattered.end(), position.neighbours.begin(),
                                position.neighbours.end());
      }
      sliced.entries.push_back({place, row->second});
    }
    sliced.slices.push_back(slice);
  }
  return sliced;
}

}  // namespace bounce
