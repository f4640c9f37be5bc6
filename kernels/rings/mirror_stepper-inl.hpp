// mirror: half of a ball of rings that is left-right symmetric; the other half is its mirror image.
// mirror_half-inl.hpp says how one thread steps it, ring_team-inl.hpp how several do.
#if defined(BOUNCE_MIRROR_STEPPER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_MIRROR_STEPPER_INL_HPP
#undef BOUNCE_MIRROR_STEPPER_INL_HPP
#else
#define BOUNCE_MIRROR_STEPPER_INL_HPP
#endif

#include <hwy/highway.h>

#include <memory>
#include <span>
#include <stdexcept>
#include <variant>
#include <vector>

#include "kernels/rings/mirror_half-inl.hpp"
#include "kernels/rings/mirror_symmetry.hpp"
#include "kernels/rings/ring_columns-inl.hpp"
#include "kernels/rings/ring_team-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// D: Highway's tag with the lanes to use. Law: the form the scene needs. R: rings.
template <class D, class Law, int R>
class MirrorStepper final : public StagedStepper {
  using Columns = RingColumns<D, Law, R>;
  using Constants = typename Columns::Constants;
  using Half = MirrorHalf<Columns>;
  using Team = RingTeam<Columns, Half>;
  static constexpr size_t L = Columns::L;

 public:
  /// `sum` as find_mirror_axis gives it; half the columns at least two a lane, and
  /// Team::fewest_columns a thread.
  MirrorStepper(const Problem& start, const RingShape& shape, std::int64_t sum, int threads)
      : StagedStepper(start),
        shape_(shape),
        sum_(sum),
        physics_(shape, start.law),
        traversal_(std::make_unique<Traversal>(make_traversal(shape.per_ring, threads))) {
    MirrorStepper::write(start.initial);
  }

  void conform(State& state) const override { make_symmetric(shape_, sum_, state); }

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
    for_each_particle([&](const double* at, int ring, std::int64_t q) {
      const bool beyond = 2 * q + ring % 2 > shape_.per_ring;  // the image of one that stands here
      if (beyond) return;
      const std::int64_t column = wrapped(q + sum_ / 2);
      put(state, ring, mirror_image(shape_, sum_, ring, column), 0.0 - at[0], at[Columns::row],
          0.0 - at[2 * Columns::row], at[3 * Columns::row]);
      put(state, ring, column, at[0], at[Columns::row], at[2 * Columns::row], at[3 * Columns::row]);
    });
  }

  void write(const State& state) override {
    if (const std::string why = not_symmetric(state, shape_, sum_); !why.empty()) {
      throw std::invalid_argument("the mirror kernel cannot take this state: " + why);
    }
    for_each_particle([&](double* at, int ring, std::int64_t q) {
      const size_t i = index_of(ring, wrapped(q + sum_ / 2));
      at[0] = state.x[i];
      at[Columns::row] = state.y[i];
      at[2 * Columns::row] = state.vx[i];
      at[3 * Columns::row] = state.vy[i];
    });
  }

 private:
  using Traversal = std::variant<Half, Team>;

  static Traversal make_traversal(std::int64_t per_ring, int threads) {
    if (threads == 1) return Traversal(std::in_place_type<Half>, per_ring);
    return Traversal(std::in_place_type<Team>, Half(per_ring), static_cast<size_t>(threads));
  }

  [[nodiscard]] std::int64_t wrapped(std::int64_t column) const {
    return ((column % shape_.per_ring) + shape_.per_ring) % shape_.per_ring;
  }
  [[nodiscard]] size_t index_of(int ring, std::int64_t column) const {
    return static_cast<size_t>(ring * shape_.per_ring + column);
  }
  void put(State& state, int ring, std::int64_t column, double x, double y, double vx,
           double vy) const {
    const size_t i = index_of(ring, column);
    state.x[i] = x;
    state.y[i] = y;
    state.vx[i] = vx;
    state.vy[i] = vy;
  }

  // Calls visit(where its x stands, ring, column from the axis above) for all that is stepped.
  template <class Visit>
  void for_each_particle(Visit visit) const {
    const auto in_half = [&](Half& half) {
      for (size_t k = 0; k < half.size(); ++k) {
        for (size_t place = 0; place < size_t{R} * L; ++place) {
          visit(half.column(k) + place, static_cast<int>(place / L),
                half.begin_of(place % L) + static_cast<std::int64_t>(k));
        }
      }
    };
    std::visit([&](auto& traversal) { in_half(whole(traversal)); }, *traversal_);
  }
  static Half& whole(Half& half) { return half; }
  static Half& whole(Team& team) { return team.whole(); }

  RingShape shape_;
  std::int64_t sum_;
  Columns physics_;
  std::unique_ptr<Traversal> traversal_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
