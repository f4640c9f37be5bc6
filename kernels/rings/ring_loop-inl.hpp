// All columns of a ball of rings, stepped by one thread a stage at a time (ring_columns-inl.hpp has
// what a column is, its two sweeps and its left sums).
//
// Why it is built so
//  1. The columns stand in one row, with a ghost behind them: a copy of column 0 as the last column
//     sees it, its lanes turned by one.
//
//         column:   0   1   2   ...   K-1 | ghost
//
//  2. Column 0 waits for the end of a stage, when its left sums arrive from the last column.
//  3. The first sweep begins with column 1: column 0, moved last in the stage before, is needed
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

#include "kernels/rings/ring_columns-inl.hpp"
#include "kernels/rings/ring_forms-inl.hpp"
#include "kernels/stepping/particle_store.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// Columns: a RingColumns.
template <class Columns>
class RingLoop {
  using Column = typename Columns::Column;
  using Constants = typename Columns::Constants;
  using Ending = typename Columns::Ending;
  using V = typename Columns::V;
  static constexpr size_t chunk = 32;  // columns; their reciprocals take 7 kB with 4 lanes

 public:
  explicit RingLoop(size_t columns)
      : size_(columns), data_((columns + 1) * Columns::block), u_(Columns::terms * (chunk + 1)) {}

  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] double* column(size_t k) { return data_.data() + k * Columns::block; }
  [[nodiscard]] const double* column(size_t k) const { return data_.data() + k * Columns::block; }

  // What RingTeam asks of it: what is beyond the two ends, from the outer columns of the first and
  // the last tile as they were before the stage, outermost first.
  static constexpr size_t sent = 1;  // columns that it needs for that, from each end of a tile
  HWY_INLINE Column before_first(const double* const*, const double* const* last) const {
    return Columns::turn(Columns::load(last[0]), -1);
  }
  HWY_INLINE Column behind_last(const double* const* first, const double* const*) const {
    return Columns::turn(Columns::load(first[0]), 1);
  }
  // Nothing has to be put right at the ends after a stage.
  void mend_first(double*) const {}
  void mend_last(double*) const {}

  HWY_NOINLINE void run(const Columns& physics, const std::vector<Constants>& constants,
                        const std::vector<Wall>& walls, std::int64_t steps) {
    for (std::int64_t s = 0; s < steps; ++s) {
      for (const Constants& c : constants) pass(physics, c, walls);
    }
  }

 private:
  HWY_INLINE void fill_ghost() {
    Columns::store(Columns::turn(Columns::load(column(0)), 1), column(size_));
  }

  // One stage.
  HWY_INLINE void pass(const Columns& physics, const Constants& c, const std::vector<Wall>& walls) {
    double* first = column(0);
    double* u = u_.data();
    double* u_first = u + chunk * Columns::terms;
    Column left;
    V lowest = Columns::high_up();
    fill_ghost();
    for (size_t k = 1; k < size_; k += chunk) {
      const size_t count = std::min(chunk, size_ - k);
      Columns::reciprocals(column(k), count, u);
      if (k == 1) {
        Columns::reciprocals(first, 1, u_first);
        physics.template sums<Ending::keep>(c, first, 1, u_first, left, lowest);
      }
      physics.template sums<Ending::move>(c, column(k), count, u, left, lowest);
    }
    physics.finish_kept(c, first, Columns::turn(left, -1), lowest);
    Columns::meet_walls(c, walls, first, size_, lowest);
  }

  size_t size_;
  AlignedArray data_, u_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
