// A whole ring of columns, stepped by one thread a stage at a time.
//
// Why it is built so
//  1. The ring is one run of columns with a ghost behind it, column 0 as the last column sees it:
//     turned by a lane where a lane is a sector, as it is where each lane is a ball of its own.
//  2. Column 0 waits for the end of a stage, when its left sums arrive from the last column.
//  3. The first sweep begins with column 1: column 0, moved last in the stage before, is wanted
//     late, so the stages overlap.
//  4. Columns are swept in chunks whose reciprocals stay in L1 beside them.
#if defined(BOUNCE_RING_LOOP_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_LOOP_INL_HPP
#undef BOUNCE_RING_LOOP_INL_HPP
#else
#define BOUNCE_RING_LOOP_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/ring_columns-inl.hpp"
#include "kernels/stepping/ring_forms-inl.hpp"
#include "kernels/stepping/ring_survey-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// Columns: a RingColumns. turned: behind the last column of a lane stands the next lane's first.
/// chunk: columns swept at a time; with 4 lanes and three rings their reciprocals take 224 bytes.
template <class Columns, bool turned, size_t chunk>
class RingLoop {
  using Column = typename Columns::Column;
  using Constants = typename Columns::Constants;
  using Rest = typename Columns::Rest;
  using T = typename Columns::T;
  using V = typename Columns::V;

 public:
  explicit RingLoop(size_t columns)
      : size_(columns), data_((columns + 1) * Columns::block), u_(Columns::terms * (chunk + 1)) {}

  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] T* column(size_t k) { return data_.data() + k * Columns::block; }
  [[nodiscard]] const T* column(size_t k) const { return data_.data() + k * Columns::block; }

  // What RingTeam asks of a walk: what is beyond its ends, from the outer columns of its first and
  // last tile as they were before the stage, outermost first.
  static constexpr size_t told = 1;  // of those columns
  HWY_INLINE Column before_first(const T* const*, const T* const* last) const {
    return turn(Columns::load(last[0]), -1);
  }
  HWY_INLINE Column behind_last(const T* const* first, const T* const*) const {
    return turn(Columns::load(first[0]), 1);
  }
  // Nothing is to be mended at the ends after a stage.
  void mend_first(T*) const {}
  void mend_last(T*) const {}

  template <class Walls>
  HWY_NOINLINE void step(const Columns& physics, const std::vector<Constants>& constants,
                         const Walls& walls, std::int64_t steps) {
    for (std::int64_t s = 0; s < steps; ++s) {
      for (const Constants& c : constants) pass(physics, c, walls);
    }
  }

  void run(const Columns& physics, const std::vector<Constants>& constants, WallsInTurns& in_turns,
           std::int64_t steps) {
    in_turns.advance(
        steps, [&](const auto& walls, FlightSurvey& to) { survey(physics, walls, to); },
        [&](const auto& walls, std::int64_t n) { step(physics, constants, walls, n); });
  }

  HWY_NOINLINE void survey(const Columns& physics, const std::vector<Wall>& walls,
                           FlightSurvey& to) {
    fill_ghost();
    survey_bonds(physics, column(0), size_, to);
    survey_particles<Columns>(walls, column(0), size_, to);
  }

 private:
  HWY_INLINE void fill_ghost() {
    Columns::store(turn(Columns::load(column(0)), 1), column(size_));
    if constexpr (Columns::has_low) {
      constexpr size_t low = Columns::low_positions;
      Columns::store(turn(Columns::load(column(0) + low), 1), column(size_) + low);
    }
  }

  // One stage.
  template <class Walls>
  HWY_INLINE void pass(const Columns& physics, const Constants& c, const Walls& walls) {
    T* first = column(0);
    T* u = u_.data();
    T* u_first = u + chunk * Columns::terms;
    V nearest = Columns::far_away();
    Column left;
    fill_ghost();
    for (size_t k = 1; k < size_; k += chunk) {
      const size_t count = std::min(chunk, size_ - k);
      Columns::reciprocals(column(k), count, u);
      if (k == 1) {
        Columns::reciprocals(first, 1, u_first);
        physics.template sums<Rest::keep>(c, walls, first, 1, u_first, left, nearest);
      }
      physics.template sums<Rest::finish>(c, walls, column(k), count, u, left, nearest);
    }
    physics.finish_kept(c, walls, first, turn(left, -1), nearest);
    Columns::mirror_at_walls(c, walls, first, size_, nearest);
  }

  static HWY_INLINE Column turn(const Column& column, int shift) {
    if constexpr (turned) {
      return Columns::turn(column, shift);
    } else {
      return column;
    }
  }

  size_t size_;
  AlignedArrayOf<T> data_, u_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
