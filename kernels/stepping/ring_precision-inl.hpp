// ring with low parts: what rounding takes from a sum is carried along beside it, in double and in
// single precision.
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

/// D: Highway's tag with the numbers and lanes to use. Low: LowParts.
template <class D, class Low>
class PrecisionStepper final : public StagedStepper {
  using Columns = RingColumns<D, FixedLaw<4, 2>, 3, Low>;
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
    visit_places(loop_, state, [](double& value, const T& high, const T* low) {
      value = static_cast<double>(high);
      if (is_single && low != nullptr) value += static_cast<double>(*low);
    });
  }
  void write(const State& state) override {
    in_turns_.forget();
    visit_places(loop_, state, [](const double& value, T& high, T* low) {
      high = static_cast<T>(value);
      if (low != nullptr) *low = static_cast<T>(value - static_cast<double>(high));
    });
  }

  [[nodiscard]] State read_low() const override {
    State all(columns_ * L * size_t{Columns::rings});
    visit_places(loop_, all, [](double& value, const T&, const T* low) {
      value = low != nullptr ? static_cast<double>(*low) : 0.0;
    });
    return all;
  }
  // In single precision write() has split a rounded sum: that is as good as the high part once the
  // low part is taken off.
  void write_low(const State& all) override {
    State sums(all.size());
    read(sums);
    State highs = sums;
    const auto take = [](std::vector<double>& from, const std::vector<double>& what) {
      for (size_t i = 0; i < from.size(); ++i) from[i] -= what[i];
    };
    if constexpr (is_single) {
      take(highs.x, all.x), take(highs.y, all.y), take(highs.vx, all.vx), take(highs.vy, all.vy);
    }
    visit_places(loop_, highs, [](const double& value, T& high, T*) {
      high = static_cast<T>(value);
    });
    visit_places(loop_, all, [](const double& value, T&, T* low) {
      if (low != nullptr) *low = static_cast<T>(value);
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
        const bool has_low = row < size_t{2} * Columns::rings ? Low::of_positions
                                                              : Low::of_velocities;
        for (size_t l = 0; l < L; ++l) {
          auto* const high = column + row * L + l;
          visit((*arrays[row / Columns::rings])[((row % Columns::rings) * L + l) * columns_ + k],
                *high, has_low ? high + Columns::low_positions : nullptr);
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
