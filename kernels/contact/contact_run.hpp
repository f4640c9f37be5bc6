// What a motion between walls was like, contact by contact, as contact_solver.hpp finds it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "kernels/model/state.hpp"

namespace bounce {

/// A motion that cannot be followed: one sentence.
class ContactError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What happened between a particle and a wall.
enum class ContactKind {
  lands,     ///< it met the wall and rests on it
  bounces,   ///< it met the wall and left it at once
  releases,  ///< it rested and was pulled off
};

struct ContactEvent {
  double time = 0.0;         ///< s
  std::size_t particle = 0;  ///< from 0
  std::size_t wall = 0;      ///< from 0
  ContactKind kind = ContactKind::lands;

  template <class Words>
  void serialize(Words& words) {
    words(time, particle, wall, kind);
  }
};

/// What happened in a motion that was followed.
struct ContactRun {
  std::vector<ContactEvent> events;  ///< in the order of time
  std::int64_t steps = 0;            ///< taken, those that were cut at an event too
  std::int64_t evaluations = 0;      ///< of the force, with those of steps not taken
  double height_cut = 0.0;           ///< a bounce lower than this counts as rest, cm

  template <class Words>
  void serialize(Words& words) {
    words(events, steps, evaluations, height_cut);
  }
};

/// Follows a motion step by step as it is solved. States are rounded to double.
class ContactWatch {
 public:
  virtual ~ContactWatch() = default;
  /// The start, and the state that goes on from after each contact.
  virtual void begin(double time, const State& state) = 0;
  /// A step ended there. `again(t)`: the state at a time (s) within the step, made anew; only until
  /// this call returns.
  virtual void step(double time, const State& end, const std::function<State(double)>& again) = 0;
  /// What happened at the end of that step, or at the start.
  virtual void contact(const ContactEvent& event) = 0;
};

}  // namespace bounce
