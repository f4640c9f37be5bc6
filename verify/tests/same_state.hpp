// Two states compared to the last bit, with a message that says where they differ, and by how much.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "kernels/model/state.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

inline bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Units in the last place of the larger; infinite if one is not finite.
inline double ulps_apart(double a, double b) {
  if (!(std::isfinite(a) && std::isfinite(b))) return std::numeric_limits<double>::infinity();
  const double larger = std::fmax(std::abs(a), std::abs(b));
  return larger == 0.0 ? 0.0 : std::abs(a - b) / (larger - std::nextafter(larger, 0.0));
}

/// The same bits in every number of the same particles. If not, the message names the first particle
/// (from 1) that differs, what of it does and by how much, how many do and the largest difference.
inline testing::AssertionResult same_state(const State& a, const State& b) {
  if (a.size() != b.size()) {
    return testing::AssertionFailure() << a.size() << " particles and " << b.size();
  }
  std::ostringstream first;
  std::size_t particles = 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    bool differs = false;
    for (const auto& [name, ours, theirs] :
         {std::tuple{"x", a.x[i], b.x[i]}, std::tuple{"y", a.y[i], b.y[i]},
          std::tuple{"vx", a.vx[i], b.vx[i]}, std::tuple{"vy", a.vy[i], b.vy[i]}}) {
      if (same_bits(ours, theirs)) continue;
      if (particles == 0) {
        first.precision(17);
        first << (differs ? ", " : "") << name << " = " << ours << " and " << theirs << " ("
              << ulps_apart(ours, theirs) << " ULP)";
      }
      differs = true;
      const double apart = std::abs(ours - theirs);
      if (!(apart <= largest)) largest = apart;  // a NaN stays
    }
    if (differs && ++particles == 1) first << " of particle " << i + 1;
  }
  if (particles == 0) return testing::AssertionSuccess();
  return testing::AssertionFailure() << first.str() << "; " << particles << " of " << a.size()
                                     << " particles differ, by up to " << largest;
}

/// For the message of a failure: the first step at which two steppers made anew differ, if they are
/// advanced one step at a time.
inline std::string where_they_part(const std::function<std::unique_ptr<Stepper>()>& make_one,
                                   const std::function<std::unique_ptr<Stepper>()>& make_other,
                                   std::int64_t steps) {
  const auto one = make_one(), other = make_other();
  for (std::int64_t step = 1; step <= steps; ++step) {
    one->advance(1);
    other->advance(1);
    const auto same = same_state(one->state(), other->state());
    if (!same) return "first at step " + std::to_string(step) + ": " + same.message();
  }
  return "one step at a time they do not differ within " + std::to_string(steps) + " steps";
}

}  // namespace bounce
