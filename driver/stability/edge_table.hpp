// What bounce stability prints of its rows.
#pragma once

#include <span>
#include <string>

#include "driver/stability/edge_row.hpp"

namespace bounce {

/// How it was measured, then a table each for free flight, the largest E, bounces and the
/// criterion. `scene_elasticity` is the E of the rows over speed, gravity and criterion.
std::string edge_table(std::span<const EdgeRow> rows, double scene_elasticity,
                       const EdgeCriterion& criterion);

}  // namespace bounce
