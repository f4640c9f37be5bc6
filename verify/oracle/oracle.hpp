// The oracle: the paper's FORTRAN program in C++, scalar, nine cases, in the listing's order and
// typing. It shares plain data types with the kernels and nothing else: it makes its own constants,
// its own neighbours and its own sums. The step itself stands in listing.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/model/scene.hpp"
#include "kernels/model/state.hpp"
#include "verify/oracle/listing.hpp"
#include "verify/oracle/listing_frame.hpp"

namespace bounce {

/// The listing's program for one scene: three rings of 120, law (3, 5), the listing's scheme; any
/// radii, E, gravity, time step and walls.
///
/// Constants: with Constants::single_precision, E, E R0^2, gravity and the time step are rounded to
/// single precision and widened, as FORTRAN does with literals that have no exponent D.
/// R0^2 is the listing's (Rest::listing) or that of the exact circles (Rest::geometry).
class Oracle {
 public:
  /// Throws std::invalid_argument naming what the listing cannot do, or a start that is not of 360
  /// particles. `run` may be another variant of the step (benchmark only).
  Oracle(const Scene& scene, const State& start, RunListing run = &exact::run_listing);
  /// Why the listing cannot run this scene; empty if it can.
  static std::string refusal(const Scene& scene);

  void step(std::int64_t steps);
  /// A copy of the particles, index 0 = particle 1.
  [[nodiscard]] State state() const;
  /// Puts the particles into another state; constants stay. Throws as the constructor does.
  void set_state(const State& state);
  /// The listing's variables, for those who check its constants.
  [[nodiscard]] const Listing& listing() const { return listing_; }

 private:
  Listing listing_;
  std::vector<Wall> walls_;
  RunListing run_;
};

}  // namespace bounce
