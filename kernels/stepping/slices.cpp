#include "kernels/stepping/slices.hpp"

#include <algorithm>
#include <map>

namespace bounce {
namespace {

// Neighbours and classes of one neighbour position, lane by lane.
struct Position {
  std::vector<std::int64_t> neighbours;
  std::vector<int> classes;
};

std::int64_t degree(const BondList& bonds, std::size_t i) {
  return i < bonds.particles() ? bonds.start[i + 1] - bonds.start[i] : 0;
}

Position gather_position(const BondList& bonds, std::size_t first, int lanes, std::int64_t k) {
  Position position;
  for (std::size_t i = first; i < first + static_cast<std::size_t>(lanes); ++i) {
    if (k < degree(bonds, i)) {
      const auto e = static_cast<std::size_t>(bonds.start[i] + k);
      position.neighbours.push_back(bonds.neighbour[e]);
      position.classes.push_back(bonds.bond_class[e]);
    } else {
      position.neighbours.push_back(static_cast<std::int64_t>(i));
      position.classes.push_back(no_bond);
    }
  }
  return position;
}

bool consecutive(const std::vector<std::int64_t>& values) {
  for (std::size_t l = 1; l < values.size(); ++l) {
    if (values[l] != values[0] + static_cast<std::int64_t>(l)) return false;
  }
  return true;
}

}  // namespace

SlicedBonds slice_bonds(const BondList& bonds, int lanes) {
  SlicedBonds sliced;
  sliced.lanes = lanes;
  std::map<std::vector<int>, std::int32_t> known;
  const auto width = static_cast<std::size_t>(lanes);
  for (std::size_t first = 0; first < bonds.particles(); first += width) {
    Slice slice{.begin = static_cast<std::int64_t>(sliced.entries.size()), .full = INT32_MAX};
    for (std::size_t i = first; i < first + width; ++i) {
      const auto neighbours = static_cast<std::int32_t>(degree(bonds, i));
      slice.full = std::min(slice.full, neighbours);
      slice.all = std::max(slice.all, neighbours);
    }
    for (std::int64_t k = 0; k < slice.all; ++k) {
      Position position = gather_position(bonds, first, lanes, k);
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
