// What a person would measure of a bouncing ball, and how well each figure was found. One
// definition for all who ask: a run, its reference, accuracy, advice.
//
//  act       A wall acts on the ball when it strikes one of its particles, and as long as it holds
//            one.
//  impact    Of a wall: from its first act to its last one before the ball comes back to it. The
//            ball comes back if, while the wall does not act for at least a look's time and a
//            quarter (look_interval), its centre has turned: it went away from the wall after the
//            last act, and comes to it before the next.
//  contact   first_contact, last_contact: the first and the last act of the course so far.
//            contact_time: the time that impacts take, all walls' together. (An elastic wall holds
//            nothing; there it is the time from the first to the last strike.)
//  restitution  Newton's coefficient, of the first impact: the speed at which the centre of mass
//            leaves over the speed at which it arrives, both along the wall's normal (Principia,
//            scholium to the laws).
//  extremes  lowest_centre, rebound_height (greatest height of the centre from its lowest on),
//            greatest_flattening: of the course, not of the looks at it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/figures/act_finder.hpp"
#include "verify/figures/ball_look.hpp"
#include "verify/figures/greatest.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {

/// A number, and how far the search for it may be off the course that was computed. (How far that
/// course is off the motion is another matter.)
struct Figure {
  double value = 0.0, found_to = 0.0;

  template <class Words>
  void serialize(Words& words) {
    words(value, found_to);
  }
};

struct Bounce {
  std::optional<Figure> first_contact, last_contact;  ///< s; nothing: no contact
  std::optional<Figure> contact_time;                 ///< s
  std::optional<Figure> lowest_centre;                ///< smallest height of the centre of mass, cm
  std::optional<Figure> lowest_centre_time;           ///< s
  std::optional<Figure> rebound_height;               ///< cm
  /// Nothing: no contact yet, not left yet, or no impact (a ball that lies or slides there: less
  /// than a hundredth of the impulse met an arriving ball).
  std::optional<Figure> restitution;
  std::optional<Figure> greatest_flattening, greatest_flattening_time;  ///< 1, s
  std::optional<Figure> end_height, end_speed;                          ///< of the centre; cm, cm/s
  std::optional<Figure> energy_lost;  ///< total energy at the start less now, erg

  template <class Words>
  void serialize(Words& words) {
    words(first_contact, last_contact, contact_time, lowest_centre, lowest_centre_time,
          rebound_height, restitution, greatest_flattening, greatest_flattening_time, end_height,
          end_speed, energy_lost);
  }
};

/// A member of Bounce by name.
struct FigureName {
  std::string_view name, unit;
  std::optional<Figure> Bounce::*figure;
};
inline constexpr std::array<FigureName, 12> figure_names{{
    {"first_contact", "s", &Bounce::first_contact},
    {"last_contact", "s", &Bounce::last_contact},
    {"contact_time", "s", &Bounce::contact_time},
    {"lowest_centre", "cm", &Bounce::lowest_centre},
    {"lowest_centre_time", "s", &Bounce::lowest_centre_time},
    {"rebound_height", "cm", &Bounce::rebound_height},
    {"restitution", "1", &Bounce::restitution},
    {"greatest_flattening", "1", &Bounce::greatest_flattening},
    {"greatest_flattening_time", "s", &Bounce::greatest_flattening_time},
    {"end_height", "cm", &Bounce::end_height},
    {"end_speed", "cm/s", &Bounce::end_speed},
    {"energy_lost", "erg", &Bounce::energy_lost},
}};

/// Time between two looks at a course, s, from the start alone: some periods of the fastest
/// vibration (a bound of it, 50 over its angular frequency), a fiftieth of the time in which the
/// ball falls its own size, or moves by it.
double look_interval(const Problem& problem);

/// From two samples: what the walls and the method took.
Figure energy_lost(const Sample& start, const Sample& now);

/// What rounding makes of a time, s, and of a height, cm.
double time_rounding(double time);
double height_rounding(const BallLook& look);

/// One impact, as far as it is known.
struct Impact {
  std::size_t wall = 0;
  WallAct first, last;
  bool acts_now = false;  ///< the wall still acts at the end of what is known
  template <class Words>
  void serialize(Words& words) {
    words(wall, first, last, acts_now);
  }
};

/// True if the ball came back to a wall between two acts. `least`: s, of a flight that counts.
bool came_back(const Wall& wall, const WallAct& last, const WallAct& next, double least);
/// look_interval() and a quarter, so that there is a look in such a flight.
double least_flight(double look_interval);

/// The figures that impacts make.
void add_contacts(const std::vector<Impact>& impacts, const Model& model, Bounce& bounce);

/// The extremes of a course, look by look.
class Extremes {
 public:
  /// `quantum`: s, times are whole multiples of it; 0: any times.
  explicit Extremes(double quantum = 0.0, std::size_t kept = 16)
      : lowest_(quantum, kept), highest_(quantum, kept), flattest_(quantum, kept) {}

  /// `from`: the state at the look before, to go on from.
  void add(double time, const BallLook& look, const KeptState& from);
  /// Where the course can be looked at again now and not later.
  using LookAt = std::function<BallLook(double time)>;
  void add_and_search(double time, const BallLook& look, const LookAt& again);

  /// Looks at a course again, as LookAgain does.
  struct SeenAgain {
    BallLook look;
    KeptState state;
  };
  using SeeAgain = std::function<SeenAgain(double time, const KeptState& from)>;
  void put_into(Bounce& bounce, const SeeAgain& again) const;

  template <class Words>
  void serialize(Words& words) {
    words(lowest_, highest_, flattest_, end_, end_time_);
  }

 private:
  void after_add(double lowest_before, double rounding);

  Greatest lowest_;   // of minus the height
  Greatest highest_;  // since the lowest
  Greatest flattest_;
  BallLook end_;
  double end_time_ = 0.0;
};

}  // namespace bounce
