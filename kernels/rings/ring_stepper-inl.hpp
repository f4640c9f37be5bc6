// ring: concentric rings with constant offsets, by sweeps over their columns (ring_columns-inl.hpp
// says how a column is computed and why).
//
// ring_walk says which walk a ball needs.
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
  /// measuring what that saves: 1 is a plain sweep through memory a stage.
  RingStepper(const Problem& start, const RingShape& shape, int threads,
              size_t stages = most_ghosts)
      : StagedStepper(start),
        physics_(shape, start.law),
        columns_(static_cast<size_t>(shape.per_ring) / L),
        walk_(std::make_unique<Walk>(make_walk(columns_, static_cast<size_t>(threads), stages))) {
    RingStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<Constants> constants;
    for (const StageConstants& stage : stages) {
      constants.push_back(physics_.make_constants(stage));
    }
    std::visit([&](auto& walk) { walk.run(physics_, constants, model().walls, steps); }, *walk_);
  }

  void read(State& state) const override {
    for_each_place(state, [](double& value, const double& place) { value = place; });
  }

  void write(const State& state) override {
    for_each_place(state, [](const double& value, double& place) { place = value; });
  }

 private:
  using Walk = std::variant<Loop, Team, Tiles>;

  static Walk make_walk(size_t columns, size_t threads, size_t stages) {
    if (stages < most_ghosts) return Walk(std::in_place_type<Tiles>, columns, threads, stages);
    switch (ring_walk(columns, threads, Columns::block * sizeof(double))) {
      case RingWalk::loop:
        return Walk(std::in_place_type<Loop>, columns);
      case RingWalk::team:
        return Walk(std::in_place_type<Team>, Loop(columns), threads);
      case RingWalk::tiles:
        break;
    }
    return Walk(std::in_place_type<Tiles>, columns, threads);
  }

  // Calls visit(value in the state, its place in a column) for all numbers.
  template <class AnyState, class Visit>
  void for_each_place(AnyState& state, Visit visit) const {
    const auto arrays = std::array{&state.x, &state.y, &state.vx, &state.vy};
    for (size_t k = 0; k < columns_; ++k) {
      double* column = std::visit([k](auto& walk) { return walk.column(k); }, *walk_);
      for (size_t row = 0; row < size_t{4} * R; ++row) {
        for (size_t l = 0; l < L; ++l) {
          visit((*arrays[row / R])[((row % R) * L + l) * columns_ + k], column[row * L + l]);
        }
      }
    }
  }

  Columns physics_;
  size_t columns_;  // vectors a ring
  std::unique_ptr<Walk> walk_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
