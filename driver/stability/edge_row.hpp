// A row of edge.csv: what was asked, and what was measured.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "verify/stability/stability_edge.hpp"

namespace bounce {

/// The columns. What is sought, E or dt, is empty in the first columns; predicted (for the
/// criterion), strict (by the method's limit), flight, stable and unstable are in its unit.
extern const char* const edge_header;

/// The first columns of a case: they name it among all of a sweep.
inline constexpr std::size_t edge_key_columns = 10;
std::string edge_key(const EdgeCase& what);

/// A row as it is read back.
struct EdgeRow {
  std::string method;
  Passage passage = Passage::flight;
  Sought sought = Sought::step;
  double elasticity = 0.0;   ///< NaN where it is sought
  double step = 0.0;         ///< s; NaN where it is sought
  double gravity = 0.0;      ///< cm/s^2
  double disturbance = 0.0;  ///< in shortest bonds
  EdgeCriterion criterion;
  Edge edge;
  double seconds = 0.0;  ///< its share of the time of those measured beside it
};

/// The row, without the end of the line.
std::string edge_line(const std::string& key, const Edge& edge, double seconds);

/// Nothing if the line is not a whole row.
std::optional<EdgeRow> read_edge_line(const std::string& line);

std::string name_of(Passage passage);
std::string name_of(EdgeOutcome outcome);

}  // namespace bounce
