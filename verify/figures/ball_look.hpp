// A cheap look at a state: all that the figures of a bounce are made of. One pass over the
// particles and one over the outer ring, no bonds: some microseconds for the paper's ball.
//
// Places and velocities are taken from those of the ball's first particle, so that a ball far away
// from the origin loses no digits; sums run in four parts, which the compiler puts into a vector.
#pragma once

#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// cm, s; unit masses.
struct BallLook {
  Vec2 centre;                   ///< of mass
  Vec2 velocity;                 ///< of the centre
  double flattening = 0.0;       ///< of the outer ring (flattening_of)
  double flattening_rate = 0.0;  ///< its derivative by time, 1/s
  double fastest = 0.0;          ///< greatest speed of a particle
  double farthest = 0.0;         ///< greatest coordinate, by size: what roundings go by
  double radius = 0.0;           ///< of gyration of the outer ring
  std::vector<double> nearest;   ///< least distance of a particle from each wall

  [[nodiscard]] bool is_finite() const;
  template <class Words>
  void serialize(Words& words) {
    words(centre.x, centre.y, velocity.x, velocity.y, flattening, flattening_rate, fastest,
          farthest, radius, nearest);
  }
};

/// The outer ring is the last of a ball of rings; any other ball is one ring.
BallLook look_at(const Model& model, const State& state);

/// Second moments of points about their centre, (xx, xy; xy, yy).
struct Moments {
  double xx = 0.0, xy = 0.0, yy = 0.0;
};
/// 1 - shorter/longer principal axis of a gyration tensor: 0 = round, 1 = a straight line. Good to
/// its last digits where it is small, too.
double flattening_of(const Moments& gyration);

}  // namespace bounce
