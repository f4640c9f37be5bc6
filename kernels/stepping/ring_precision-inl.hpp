// ring with low parts: what rounding takes from a sum is carried along beside it, in double
// (compensated) and in single precision. Double without low parts is ring_stepper-inl.hpp.
//
// Why it is built so
//  1. Positions and velocities are high + low. The low part of a velocity begins the sum of its
//     bonds, so the kick is summed among numbers of its own size; then high + kick, and what that
//     rounds away is the new low part. The same for drift: c v + low.
//  2. Three operations a sum (the fast form): it is exact where the kick or drift is the smaller
//     number; where a coordinate passes 0 it is off by an ULP of the drift, as c v is anyway.
//  3. The first sweep takes lengths from high and low parts: R^2 stands for a strain, and an ULP of
//     10 cm is 30 of a bond. High parts differ exactly (two within a factor 2; else by one
//     rounding). The second sweep, directions, takes the high parts alone: its differences are
//     multiplied by a force that is small where bonds are near rest.
//  4. Walls are met by the high part; the low part is turned as the high one. For a floor both are
//     exact. Other walls round: by 5e-7 cm a contact in single precision, which refuses them.
//  5. Single takes twice the lanes of AVX2, eight floats. With AVX-512 too, in half vectors: 120
//     columns are 7.5 of 16.
//  6. Single runs the wall test always: the bound of free flight counts double's roundings.
//  7. A snapshot keeps high and low parts, so a run goes on with the same bits; a state (file,
//     frame) is rounded to doubles, and a run from it begins with what these hold.
//
// Errors, largest of 360 particles after 100 000 steps of 1e-6 s in free flight, cm (against 64-bit
// significands): double 4.0e-13; low positions alone 1.4e-14; low velocities too 7.3e-16; low parts
// in lengths too, as here, 1.5e-16. Single: 6.0e-6, 5.8e-7, 2.9e-7; of that 2.4e-7 are the
// constants' rounding.
#if defined(BOUNCE_RING_PRECISION_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_PRECISION_INL_HPP
#undef BOUNCE_RING_PRECISION_INL_HPP
#else
#define BOUNCE_RING_PRECISION_INL_HPP
#endif

#include <hwy/highway.h>

#include <array>
#include <span>
#include <type_traits>
#include <vector>

#include "kernels/stepping/ring_columns-inl.hpp"
#include "kernels/stepping/ring_loop-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// D: Highway's tag with the numbers and lanes to use.
template <class D>
class PrecisionStepper final : public StagedStepper {
  using Columns = RingColumns<D, FixedLaw<4, 2>, 3, true>;
  using Constants = typename Columns::Constants;
  using T = typename Columns::T;
  static constexpr size_t L = Columns::L;
  static constexpr bool is_single = std::is_same_v<T, float>;

 public:
  PrecisionStepper(const Problem& start, const RingShape& shape, bool free_flight)
      : StagedStepper(start),
        physics_(shape, start.law),
        in_turns_(start, free_flight),
        columns_(static_cast<size_t>(shape.per_ring) / L),
        loop_(columns_) {
    PrecisionStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<Constants> constants;
    for (const StageConstants& stage : stages) constants.push_back(physics_.make_constants(stage));
    if constexpr (is_single) {
      in_turns_.advance_walled(steps, [&](const auto& walls, std::int64_t n) {
        loop_.step(physics_, constants, walls, n);
      });
    } else {
      loop_.run(physics_, constants, in_turns_, steps);
    }
  }

  // In double the high part is the sum, rounded.
  void read(State& state) const override {
    visit_places(loop_, state, [](double& value, const T& high, const T& low) {
      value = static_cast<double>(high);
      if constexpr (is_single) value += static_cast<double>(low);
    });
  }
  void write(const State& state) override {
    in_turns_.forget();
    visit_places(loop_, state, [](const double& value, T& high, T& low) {
      high = static_cast<T>(value);
      low = static_cast<T>(value - static_cast<double>(high));
    });
  }

  [[nodiscard]] State read_low() const override {
    State all(columns_ * L * size_t{Columns::rings});
    visit_places(loop_, all,
                 [](double& value, const T&, const T& low) { value = static_cast<double>(low); });
    return all;
  }
  // In single precision write() has split a rounded sum: that is as good as the high part once the
  // low part is taken off.
  void write_low(const State& all) override {
    visit_places(loop_, all, [](const double& value, T& high, T& low) {
      if constexpr (is_single) {
        high = static_cast<T>(static_cast<double>(high) + static_cast<double>(low) - value);
      }
      low = static_cast<T>(value);
    });
  }

 private:
  using Loop = RingLoop<Columns, true, 32>;

  // Calls visit(number in the state, its high part, its low part or null) for all numbers.
  template <class AnyLoop, class AnyState, class Visit>
  void visit_places(AnyLoop& loop, AnyState& state, Visit visit) const {
    const auto arrays = std::array{&state.x, &state.y, &state.vx, &state.vy};
    for (size_t k = 0; k < columns_; ++k) {
      auto* const column = loop.column(k);
      for (size_t row = 0; row < size_t{4} * Columns::rings; ++row) {
        for (size_t l = 0; l < L; ++l) {
          auto* const high = column + row * L + l;
          visit((*arrays[row / Columns::rings])[((row % Columns::rings) * L + l) * columns_ + k],
                *high, high[Columns::low_positions]);
        }
      }
    }
  }

  Columns physics_;
  WallsInTurns in_turns_;
  size_t columns_;  // vectors a ring
  Loop loop_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
