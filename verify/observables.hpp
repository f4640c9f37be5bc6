// What a person would measure of a bouncing ball.
#pragma once

#include <cstdint>

#include "kernels/model/problem.hpp"
#include "verify/monitor.hpp"

namespace bounce {

/// Shape and motion of one state.
struct Shape {
  double width = 0.0;   ///< extent in x, cm
  double height = 0.0;  ///< extent in y, cm
  double flattening =
      0.0;  ///< 1 - shorter/longer principal axis of the outer ring (its gyration tensor)
  double enclosed =
      0.0;            ///< signed area inside the inner ring, cm^2; falls to 0 or below on collapse
  double spin = 0.0;  ///< angular momentum / moment of inertia, rad/s; negative = clockwise
};

/// Throws std::invalid_argument if the particles cannot be `rings` rings of one size.
Shape measure_shape(const State& state, int rings);

/// Gathers a bounce from samples given in the order of time.
struct Bounce {
  double lowest_centre = 0.0;       ///< smallest height of the centre of mass, cm
  double lowest_centre_time = 0.0;  ///< s
  double first_contact = -1.0;      ///< time of the first sample with contact, s; -1: none yet
  double last_contact = -1.0;       ///< time of the last sample with contact, s; -1: none yet
  double contact_time = 0.0;        ///< total, s: half an interval for each of its ends in contact
  double rebound_height = 0.0;      ///< greatest centre height from the lowest point on, cm
  double energy_lost = 0.0;         ///< total energy at the start less now, erg
};
class BounceGauge {
 public:
  /// Throws std::invalid_argument for a time (s) that is not after the last one, or a sample whose
  /// energy or centre is not finite.
  void add(double time, const Sample& sample);
  [[nodiscard]] const Bounce& result() const { return bounce_; }

 private:
  Bounce bounce_;
  bool any_ = false;
  bool touched_ = false;  ///< the last sample was in contact
  double start_energy_ = 0.0;
  double last_time_ = 0.0;
};

}  // namespace bounce
