// Shape and turning of one state.
#pragma once

#include "kernels/model/state.hpp"

namespace bounce {

struct Shape {
  double width = 0.0;       ///< extent in x, cm
  double height = 0.0;      ///< extent in y, cm
  double flattening = 0.0;  ///< 1 - shorter/longer principal axis of the outer ring (flattening_of)
  /// Signed area inside the inner ring, cm^2; falls to 0 or below on collapse. NaN without rings.
  double enclosed = 0.0;
  double spin = 0.0;  ///< angular momentum / moment of inertia, rad/s; negative = clockwise
};

/// Throws std::invalid_argument if the particles cannot be `rings` rings of one size.
Shape measure_shape(const State& state, int rings);
/// Of a ball without rings, all of which is its outer ring.
Shape measure_shape(const State& state);

}  // namespace bounce
