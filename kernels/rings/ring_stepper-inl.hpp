// ring: a ball of concentric rings whose bonds have constant offsets, stepped by sweeps over its
// columns. How one column is computed, and why so, is in ring_columns-inl.hpp; in which order the
// columns are taken depends on the ball and the threads (ring_traversal in ring_forms.hpp):
//
//   ring_loop-inl.hpp    one thread, a stage at a time
//   ring_team-inl.hpp    a few threads on a small ball, a stage at a time
//   ring_tiles-inl.hpp   a large ball, several stages on a part of it while that is in cache
#if defined(BOUNCE_RING_STEPPER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_STEPPER_INL_HPP
#undef BOUNCE_RING_STEPPER_INL_HPP
#else
#define BOUNCE_RING_STEPPER_INL_HPP
#endif

#include <hwy/highway.h>

#include <array>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "kernels/rings/ring_columns-inl.hpp"
#include "kernels/rings/ring_forms.hpp"
#include "kernels/rings/ring_loop-inl.hpp"
#include "kernels/rings/ring_team-inl.hpp"
#include "kernels/rings/ring_tiles-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// D: Highway's tag with the lanes to use. Law: the form the scene needs. R: rings.
template <class D, class Law, int R>
class RingStepper final : public StagedStepper {
  using Columns = RingColumns<D, Law, R>;
  using Constants = typename Columns::Constants;
  using Loop = RingLoop<Columns>;
  using Team = RingTeam<Columns, Loop>;
  using Tiles = RingTiles<Columns>;
  static constexpr size_t L = Columns::L;

 public:
  /// `stages`: at most so many are taken while a tile is in cache. Fewer than most_ghosts are for
  /// measuring what that saves: with 1 each stage is a plain sweep through memory.
  RingStepper(const Problem& start, const RingShape& shape, int threads,
              size_t stages = most_ghosts)
      : StagedStepper(start),
        physics_(shape, start.law),
        columns_(static_cast<size_t>(shape.per_ring) / L),
        traversal_(std::make_unique<Traversal>(
            make_traversal(columns_, static_cast<size_t>(threads), stages))) {
    RingStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<Constants> constants;
    for (const StageConstants& stage : stages) {
      constants.push_back(physics_.make_constants(stage));
    }
    std::visit([&](auto& traversal) { traversal.run(physics_, constants, model().walls, steps); },
               *traversal_);
  }

  void read(State& state) const override {
    for_each_place(state, [](double& value, const double& place) { value = place; });
  }

  void write(const State& state) override {
    for_each_place(state, [](const double& value, double& place) { place = value; });
  }

 private:
  using Traversal = std::variant<Loop, Team, Tiles>;

  static Traversal make_traversal(size_t columns, size_t threads, size_t stages) {
    if (stages < most_ghosts) return Traversal(std::in_place_type<Tiles>, columns, threads, stages);
    switch (ring_traversal(columns, threads, Columns::block * sizeof(double))) {
      case RingTraversal::loop:
        return Traversal(std::in_place_type<Loop>, columns);
      case RingTraversal::team:
        return Traversal(std::in_place_type<Team>, Loop(columns), threads);
      case RingTraversal::tiles:
        break;
    }
    return Traversal(std::in_place_type<Tiles>, columns, threads);
  }

  // Calls visit(value in the state, its place in a column) for all numbers.
  template <class AnyState, class Visit>
  void for_each_place(AnyState& state, Visit visit) const {
    const auto arrays = std::array{&state.x, &state.y, &state.vx, &state.vy};
    for (size_t k = 0; k < columns_; ++k) {
      double* column =
          std::visit([k](auto& traversal) { return traversal.column(k); }, *traversal_);
      for (size_t row = 0; row < size_t{4} * R; ++row) {
        for (size_t l = 0; l < L; ++l) {
          visit((*arrays[row / R])[((row % R) * L + l) * columns_ + k], column[row * L + l]);
        }
      }
    }
  }

  Columns physics_;
  size_t columns_;  // vectors a ring
  std::unique_ptr<Traversal> traversal_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
