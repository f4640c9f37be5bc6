// What a motion between walls was like, contact by contact, as contact_solver.hpp finds it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

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
};

/// What happened in a motion that was followed.
struct ContactRun {
  std::vector<ContactEvent> events;  ///< in the order of time
  std::int64_t steps = 0;            ///< taken, those that were cut at an event too
  std::int64_t evaluations = 0;      ///< of the force, with those of steps not taken
  double height_cut = 0.0;           ///< a bounce lower than this counts as rest, cm
};

}  // namespace bounce
