// The ensemble kernel: lane = scene.
//
// Why it is built so
//  1. Scenes of one shape do the same operations on other numbers: E, g, dt and walls stand in the
//     lanes of constants that are vectors anyway. So a batch of four (or eight) scenes is a ring of
//     per_ring columns by the code of ring_columns-inl.hpp, and the operations on a scene are those
//     of the kernel `ring`, in the same order: it gives ring's bits.
//  2. No lane is ever turned: behind a scene's last column stands its first.
//  3. Four scenes take 46 kB, more than L1 holds. They stream through it from L2, which the next
//     columns leave in time.
//
//         lane:       0         1         2         3
//         vector k:   scene a   scene b   scene c   scene d    column k of each
//
// Operations: ring's, per_ring columns for as many scenes as lanes.
//
// Not taken: several stages at a time within L1, as a tile of ring_tiles-inl.hpp (4 to 8 % slower
// on Zen 3 with 2 to 8 stages: the ghosts cost more than L2), or as fronts of 2 to 8 stages that
// follow each other a chunk of 8 to 24 columns behind, without ghosts (same bits; on Zen 4 with 8
// lanes, whose scenes take 92 kB, 1 % faster at best: L2 is not what limits); two sectors each of
// two scenes (lanes would have to be turned, for half of the memory). No free flight: a lane may be
// at its wall when another is far from its own. So a batch always tests, where `ring` often does
// not.
#if defined(BOUNCE_ENSEMBLE_BATCH_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_ENSEMBLE_BATCH_INL_HPP
#undef BOUNCE_ENSEMBLE_BATCH_INL_HPP
#else
#define BOUNCE_ENSEMBLE_BATCH_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "kernels/stepping/ensemble_batch.hpp"
#include "kernels/stepping/ring_columns-inl.hpp"
#include "kernels/stepping/ring_loop-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A wall that nothing reaches, for lanes with fewer walls than others.
inline Wall far_wall() { return {{0.0, 1.0}, -std::numeric_limits<double>::infinity(), 0.0, 0.0}; }

/// Each lane's walls, as vectors.
template <class D>
class LaneWalls {
 public:
  using V = hn::Vec<D>;
  static constexpr size_t L = hn::MaxLanes(D());

  explicit LaneWalls(size_t most) : walls_(most * L, far_wall()), vectors_(most) { gather(); }
  void set(size_t lane, const std::vector<Wall>& walls) {
    for (size_t w = 0; w < vectors_.size(); ++w) {
      walls_[w * L + lane] = w < walls.size() ? walls[w] : far_wall();
    }
    gather();
  }
  [[nodiscard]] const WallVectors<V>& operator[](size_t w) const { return vectors_[w]; }

 protected:
  void gather() {
    for (size_t w = 0; w < vectors_.size(); ++w) {
      const Wall* lanes = walls_.data() + w * L;
      const auto each = [lanes](const auto& value_of) HWY_ATTR {
        HWY_ALIGN double values[L];
        for (size_t l = 0; l < L; ++l) values[l] = value_of(lanes[l]);
        return hn::Load(D(), values);
      };
      vectors_[w] = {
          each([](const Wall& wall) { return wall.normal.x; }),
          each([](const Wall& wall) { return wall.normal.y; }),
          each([](const Wall& wall) { return wall.offset; }),
          each([](const Wall& wall) { return wall.alpha; }),
          each([](const Wall& wall) { return wall.beta; }),
          each([](const Wall& wall) { return wall.contact == Contact::resolved ? 1.0 : 0.0; })};
    }
  }

  std::vector<Wall> walls_;  // by wall and lane
  std::vector<WallVectors<V>> vectors_;
};

/// Each lane a floor of its own, or none.
template <class D>
struct LaneFloors : LaneWalls<D> {
  using V = hn::Vec<D>;
  static constexpr bool any = true;
  explicit LaneFloors(size_t) : LaneWalls<D>(1) {}
  HWY_INLINE hn::Mask<D> clear(D d, V, V y) const { return hn::Gt(y, threshold(d)); }
  HWY_INLINE V distance(D, V, V y) const { return y; }
  HWY_INLINE V threshold(D) const { return (*this)[0].offset; }
  void mirror(D d, V drift, double* x, double* y, double* vx, double* vy) const {
    reflect(d, (*this)[0], drift, x, y, vx, vy);
  }
};

/// Each lane walls of its own.
template <class D>
struct LaneAnyWalls : LaneWalls<D> {
  using V = hn::Vec<D>;
  static constexpr bool any = true;
  explicit LaneAnyWalls(size_t most) : LaneWalls<D>(most) {}
  HWY_INLINE hn::Mask<D> clear(D d, V x, V y) const {
    return hn::Gt(distance(d, x, y), threshold(d));
  }
  HWY_INLINE V distance(D, V x, V y) const {
    V nearest = distance_from((*this)[0], x, y);
    for (size_t w = 1; w < this->vectors_.size(); ++w) {
      nearest = hn::Min(distance_from((*this)[w], x, y), nearest);
    }
    return nearest;
  }
  HWY_INLINE V threshold(D d) const { return hn::Zero(d); }
  void mirror(D d, V drift, double* x, double* y, double* vx, double* vy) const {
    for (const WallVectors<V>& wall : this->vectors_) reflect(d, wall, drift, x, y, vx, vy);
  }
};

/// D: Highway's tag with the lanes to use. Law: the form of the law. Walls: LaneFloors or
/// LaneAnyWalls. R: rings.
template <class D, class Law, class Walls, int R>
class RingBatch final : public EnsembleBatch {
  using Columns = RingColumns<D, Law, R>;
  using Constants = typename Columns::Constants;
  static constexpr size_t L = Columns::L;
  static constexpr size_t chunk = 24;  // columns; 40 and more were slower by 1 to 4 %

 public:
  explicit RingBatch(const BatchForm& form)
      : physics_(form.shape, form.law),
        walls_(form.most_walls),
        ring_(static_cast<size_t>(form.shape.per_ring)) {}

  [[nodiscard]] size_t lanes() const override { return L; }

  void write(size_t lane, const State& state, const std::vector<Wall>& walls) override {
    walls_.set(lane, walls);
    const std::vector<double>* const arrays[] = {&state.x, &state.y, &state.vx, &state.vy};
    for_each_place(lane, [&](size_t array, size_t i, size_t k, size_t place) {
      ring_.column(k)[place] = (*arrays[array])[i];
    });
  }

  void read(size_t lane, State& state) const override {
    std::vector<double>* const arrays[] = {&state.x, &state.y, &state.vx, &state.vy};
    for_each_place(lane, [&](size_t array, size_t i, size_t k, size_t place) {
      (*arrays[array])[i] = ring_.column(k)[place];
    });
  }

  HWY_NOINLINE void run(std::span<const LaneStages> lanes, std::int64_t steps) override {
    const std::vector<Constants> constants = make_constants(lanes);
    ring_.step(physics_, constants, walls_, steps);
  }

 private:
  // Calls visit(array, particle, column, place in the column's block) for all numbers of a lane.
  template <class Visit>
  void for_each_place(size_t lane, Visit visit) const {
    const size_t columns = ring_.size();
    for (size_t k = 0; k < columns; ++k) {
      for (size_t row = 0; row < size_t{4} * R; ++row) {
        visit(row / R, (row % R) * columns + k, k, row * L + lane);
      }
    }
  }

  [[nodiscard]] std::vector<Constants> make_constants(std::span<const LaneStages> lanes) const {
    size_t count = 0;
    for (const LaneStages stages : lanes) {
      if (stages != nullptr) count = stages->size();
    }
    std::vector<Constants> constants;
    for (size_t s = 0; s < count; ++s) {
      const StageConstants* stage[L];
      for (size_t l = 0; l < L; ++l) stage[l] = lanes[l] == nullptr ? nullptr : &(*lanes[l])[s];
      constants.push_back(physics_.make_constants(stage));
    }
    return constants;
  }

  Columns physics_;
  Walls walls_;
  RingLoop<Columns, false, chunk> ring_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
