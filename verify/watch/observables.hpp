// What a person would measure of a bouncing ball.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {

/// Shape and motion of one state.
struct Shape {
  double width = 0.0;   ///< extent in x, cm
  double height = 0.0;  ///< extent in y, cm
  double flattening =
      0.0;  ///< 1 - shorter/longer principal axis of the outer ring (its gyration tensor)
  /// Signed area inside the inner ring, cm^2; falls to 0 or below on collapse. NaN without rings.
  double enclosed = 0.0;
  double spin = 0.0;  ///< angular momentum / moment of inertia, rad/s; negative = clockwise
};

/// Throws std::invalid_argument if the particles cannot be `rings` rings of one size.
Shape measure_shape(const State& state, int rings);
/// Of a ball without rings, all of which is its outer ring.
Shape measure_shape(const State& state);

/// A bounce, gathered from samples in the order of time.
struct Bounce {
  double lowest_centre = 0.0;       ///< smallest height of the centre of mass, cm
  double lowest_centre_time = 0.0;  ///< s
  double first_contact = -1.0;      ///< when contact begins, s; -1: none yet
  double last_contact = -1.0;       ///< when it was last seen, s; -1: none yet
  double contact_time = 0.0;        ///< total, s
  double rebound_height = 0.0;      ///< greatest centre height from the lowest point on, cm
  double energy_lost = 0.0;         ///< total energy at the start less now, erg
  /// Coefficient of restitution of the first impact, Newton's: speed at which the centre of mass
  /// leaves over speed at which it arrives, both along the normal of the wall that gave it most
  /// impulse, from the first contact to the last before the centre comes back (Principia, scholium
  /// to the laws). None: no contact yet, not left yet, or no impact (a ball that lies or slides
  /// there: less than a hundredth of the impulse met an arriving ball). Good to g times the
  /// interval of samples.
  std::optional<double> restitution;
  double greatest_flattening = 0.0;  ///< of the shapes given
  double greatest_flattening_time = 0.0;

  template <class Words>
  void serialize(Words& words) {
    words(lowest_centre, lowest_centre_time, first_contact, last_contact, contact_time,
          rebound_height, energy_lost, restitution, greatest_flattening, greatest_flattening_time);
  }
};

/// What the walls did in the interval between two samples.
struct Push {
  bool contact = false;
  Vec2 impulse;  ///< cm/s, unit masses
};

class BounceGauge {
 public:
  /// Of a ball above the X axis, or between these walls.
  BounceGauge() : BounceGauge(std::vector<Wall>{Wall{}}) {}
  explicit BounceGauge(std::vector<Wall> walls) : walls_(std::move(walls)) {}

  /// Contact as the samples show it (Sample::on_wall): half an interval for each of its ends in
  /// contact. That is little where particles come off the wall at once (beta near -1). Throws
  /// std::invalid_argument for a time (s) that is not after the last one, or a sample whose energy
  /// or centre is not finite.
  void add(double time, const Sample& sample);
  /// Contact as the walls' impulse shows it: the intervals in which there is some. With it comes
  /// the coefficient of restitution.
  void add(double time, const Sample& sample, const Push& push);
  /// The shape at that time.
  void add_shape(double time, const Shape& shape);
  [[nodiscard]] const Bounce& result() const { return bounce_; }
  template <class Words>
  void serialize(Words& words) {
    words(bounce_, any_, touched_, start_energy_, last_time_, last_momentum_.x, last_momentum_.y,
          impact_, impact_over_, arriving_.x, arriving_.y, leaving_.x, leaving_.y, impulse_.x,
          impulse_.y);
  }

 private:
  void add_sample(double time, const Sample& sample);
  void add_to_impact(const Sample& sample, const Push& push);

  std::vector<Wall> walls_;
  Bounce bounce_;
  bool any_ = false;
  bool touched_ = false;  // the last sample was in contact
  double start_energy_ = 0.0;
  double last_time_ = 0.0;
  Vec2 last_momentum_;
  // The first impact: momenta before it and at its last contact, impulse so far.
  bool impact_ = false, impact_over_ = false;
  Vec2 arriving_, leaving_, impulse_;
};

}  // namespace bounce
