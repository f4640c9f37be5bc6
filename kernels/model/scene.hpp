// What a user asks for, as plain data. A scene's numbers travel like this:
//
//   scene file (driver) -> Scene -> make_problem -> Problem -> make_plan -> Plan -> make_stepper
//   -> Stepper (the kernel's own layout of the particles) -> State (listing order) -> monitor,
//   frames, final state -> pictures.
//
// Scene holds what the user wrote, in nominal decimals; Problem holds the numbers that are computed
// with (rounded to single precision where the scene says so).
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace bounce {

/// A vector of the plane; units as its user says.
struct Vec2 {
  double x = 0.0;
  double y = 0.0;

  bool operator==(const Vec2&) const = default;
};

/// How E, E R0^2, g and the time step are stored before they are computed with.
enum class Constants {
  single_precision,  ///< rounded to single precision, as FORTRAN reads the listing's literals
  double_precision,
};

/// Whether initial positions and velocities pass through the listing's FORMAT (F12.4).
enum class Rounding { listing, none };

/// Where the rest lengths of the bonds come from.
enum class Rest {
  listing,   ///< the listing's five constants: only for three rings of 120 at 5, 6, 7 cm
  geometry,  ///< the distances of the exact circles, a disc's spacing
};

/// What a ball is built of.
enum class BallKind {
  rings,  ///< round one centre; every other ring is staggered by half a spacing
  disc,   ///< filled, on a triangular lattice
};

/// The ball at the start. Rings need per_ring, a disc needs spacing.
struct BallSpec {
  BallKind kind = BallKind::rings;
  std::vector<double> radii{5.0, 6.0, 7.0};  ///< cm, increasing; of a disc its one radius
  std::int64_t per_ring = 120;
  std::optional<double> spacing{};  ///< cm, of a disc's lattice
  Vec2 centre{0.0, 10.0};           ///< cm
  Vec2 velocity{};                  ///< cm/s, of every particle
  Rounding rounding = Rounding::listing;

  bool operator==(const BallSpec&) const = default;
};

/// Force between neighbours at distance R: -G/R^p + H/R^q, G = elasticity, H = G R0^(q-p).
struct LawSpec {
  double p = 3.0;
  double q = 5.0;
  double elasticity = 16000.0;  ///< the paper's E (unit masses, cgs)
  Rest rest = Rest::listing;

  bool operator==(const LawSpec&) const = default;
};

/// How a wall meets a particle (wall_rule.hpp).
enum class Contact {
  listing,   ///< the paper's: mirrored at the end of the drift that crossed the wall
  resolved,  ///< its limit for small steps: the crossing located, what is pressed on sticks
  located,   ///< that limit to the method's order: the step is cut at each contact (located.hpp)
};

/// A rigid half-plane. The ball stays where normal.x > offset; a particle that does not is
/// mirrored, its tangential velocity multiplied by alpha and its normal velocity by beta (paper,
/// section 3), or what `contact` says.
struct Wall {
  Vec2 normal{0.0, 1.0};
  double offset = 0.0;  ///< cm
  double alpha = 0.0;   ///< 0 (full friction) to 1 (frictionless)
  double beta = 0.0;    ///< -1 (elastic) to 0
  Contact contact = Contact::listing;

  bool operator==(const Wall&) const = default;
};

/// Step and length of a run.
struct TimeSpec {
  double step = 1e-6;  ///< s
  double end = 15.0;   ///< s
  std::string method = "listing";

  bool operator==(const TimeSpec&) const = default;
};

/// What a run writes, and when. Either of the two frame keys may be given, not both.
struct OutputSpec {
  std::optional<double> frames_every;  ///< s
  std::vector<double> frames_at;       ///< s
  double monitor_every = 0.01;         ///< s

  bool operator==(const OutputSpec&) const = default;
};

/// One simulation, as its scene file says it.
struct Scene {
  std::string title;
  Constants constants = Constants::single_precision;
  BallSpec ball;
  LawSpec law;
  Vec2 gravity{0.0, -0.098};  ///< cm/s^2
  std::vector<Wall> walls;
  TimeSpec time;
  OutputSpec output;

  /// Number of steps from 0 to t (s), in the nominal step as the paper counts them.
  [[nodiscard]] std::int64_t steps_until(double t) const;

  bool operator==(const Scene&) const = default;
};

/// A value that a scene may not have: which key, what stands there, what is allowed.
class SceneError : public std::invalid_argument {
 public:
  SceneError(std::string at_key, std::string found, std::string may_be);
  std::string key;      ///< as in the scene file: "ball.radii[1]", "wall[0].alpha"
  std::string value;    ///< what was given
  std::string allowed;  ///< what may stand there
};

/// Throws SceneError at the first value that is out of range. Everything that can be said without
/// building the ball is checked here; make_problem checks the rest (walls behind the ball).
void validate(const Scene& scene);

}  // namespace bounce
