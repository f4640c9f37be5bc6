// Half of a ball of rings that is left-right symmetric, stepped by one thread. A column is the
// particles of all rings at one angle (ring_columns-inl.hpp).
//
// Why it is built so
//  1. The axis goes through a column of the rings without stagger, above and below, and between two
//     columns of the staggered rings. Counted from the axis above, the half has columns
//     0 .. half - 1 and, of the rings without stagger, column `half`. Column q's image is -q, on a
//     staggered ring -1 - q:
//
//         without stagger:   -1   (0)    1     2   ...   half-1  (half)   half+1
//         staggered:            -1 |  0     1    ...  half-1  |  half
//                                axis                       axis
//
//  2. Each lane computes columns 0 .. K of its own, K = half / L rounded down, with a ghost at
//     either side. The first lane begins at column 0, the last at half - K, so that its column K is
//     the particle on the axis below; the others begin evenly between. A lane whose neighbour
//     begins K + 1 columns on is long. If K columns on, it is short: its column K is the
//     neighbour's column 0, computed twice, to the same bits.
//  3. The ghosts of a stage come from the neighbour lane, or from the mirror image in the first and
//     the last lane. After it particles on the axis are put back on it (x = 0, vx = 0), since the
//     sums from left and right cancel but for rounding.
//  4. The bonds across the axis so need no code of their own.
//
// Operations: K + 1 columns and the left sums of one more, where the full ball has 2 half / L: with
// 4 lanes 17 columns instead of 30, with 8 lanes 9 instead of 15.
//
// Not taken: the two particles on the axis as scalars (K columns only, but their bonds, which sit
// in lanes of other columns, would have to be taken out one by one).
#if defined(BOUNCE_MIRROR_HALF_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_MIRROR_HALF_INL_HPP
#undef BOUNCE_MIRROR_HALF_INL_HPP
#else
#define BOUNCE_MIRROR_HALF_INL_HPP
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
namespace hn = hwy::HWY_NAMESPACE;

/// Columns: a RingColumns.
template <class Columns>
class MirrorHalf {
  using Column = typename Columns::Column;
  using Constants = typename Columns::Constants;
  using Ending = typename Columns::Ending;
  using V = typename Columns::V;
  using D = hn::DFromV<V>;
  static constexpr D d{};
  static constexpr size_t L = Columns::L;
  static constexpr int R = Columns::rings;
  static constexpr size_t block = Columns::block;
  static constexpr size_t chunk = 32;  // columns whose reciprocals are kept

 public:
  /// per_ring: of the whole ball; half of it at least two columns a lane.
  explicit MirrorHalf(std::int64_t per_ring)
      : half_(per_ring / 2),
        last_(static_cast<size_t>(half_) / L),
        data_((last_ + 3) * block),
        u_(Columns::terms * (chunk + 2)),
        long_(L) {
    for (size_t l = 0; l < L; ++l) {
      const bool is_long = begin_of(l + 1) - begin_of(l) > static_cast<std::int64_t>(last_);
      long_[l] = is_long ? 1.0 : 0.0;
    }
  }

  /// Columns that are stepped, 0 .. K.
  [[nodiscard]] size_t size() const { return last_ + 1; }
  [[nodiscard]] double* column(size_t k) { return data_.data() + (k + 1) * block; }
  [[nodiscard]] const double* column(size_t k) const { return data_.data() + (k + 1) * block; }
  /// Of the half, the column at which lane l begins.
  [[nodiscard]] std::int64_t begin_of(size_t l) const {
    constexpr auto after_first = std::max<std::int64_t>(1, static_cast<std::int64_t>(L) - 1);
    return static_cast<std::int64_t>(l) * (half_ - static_cast<std::int64_t>(last_)) / after_first;
  }

  HWY_NOINLINE void run(const Columns& physics, const std::vector<Constants>& constants,
                        const std::vector<Wall>& walls, std::int64_t steps) {
    mend_first(column(0));
    mend_last(column(last_));
    for (std::int64_t s = 0; s < steps; ++s) {
      for (const Constants& c : constants) pass(physics, c, walls);
    }
  }

  // What RingTeam asks of it: what is beyond the two ends, from the outer columns of the first and
  // the last tile as they were before the stage, outermost first.
  static constexpr size_t sent = 3;  // columns that it needs for that, from each end of a tile
  HWY_INLINE Column before_first(const double* const* first, const double* const* last) const {
    const Column previous =
        Columns::turn(by_length(Columns::load(last[0]), Columns::load(last[1])), -1);
    return with_image(previous, 0, first[1], first[0]);
  }
  HWY_INLINE Column behind_last(const double* const* first, const double* const* last) const {
    const Column next = by_length(Columns::turn(Columns::load(first[0]), 1),
                                  Columns::turn(Columns::load(first[1]), 1));
    return with_image(next, L - 1, last[1], last[2]);
  }

  /// Puts the particles on the axis above back on it.
  static HWY_INLINE void mend_first(double* first) { put_on_axis(first, 0); }
  /// The same below; of the staggered rings the last lane's column is the image of the one before.
  static HWY_INLINE void mend_last(double* last) {
    put_on_axis(last, L - 1);
    const double* inner = last - block;
    const auto here = lane_is(L - 1);
    for (int r = 1; r < R; r += 2) {
      const V x = hn::IfThenElse(here, hn::Sub(hn::Zero(d), Columns::x_of(inner, r)),
                                 Columns::x_of(last, r));
      const V y = hn::IfThenElse(here, Columns::y_of(inner, r), Columns::y_of(last, r));
      hn::Store(x, d, last + static_cast<size_t>(r) * L);
      hn::Store(y, d, last + Columns::row + static_cast<size_t>(r) * L);
    }
  }

 private:
  [[nodiscard]] double* before() { return data_.data(); }
  [[nodiscard]] double* behind() { return column(last_ + 1); }

  static HWY_INLINE hn::Mask<D> lane_is(size_t lane) {
    return hn::Eq(hn::Iota(d, 0), hn::Set(d, static_cast<double>(lane)));
  }
  // `column`, but in `lane` the mirror image of rings without stagger at `plain`, of staggered ones
  // at `staggered`.
  static HWY_INLINE Column with_image(Column column, size_t lane, const double* plain,
                                      const double* staggered) {
    const auto here = lane_is(lane);
    for (int r = 0; r < R; ++r) {
      const double* image = r % 2 == 0 ? plain : staggered;
      column.x[r] =
          hn::IfThenElse(here, hn::Sub(hn::Zero(d), Columns::x_of(image, r)), column.x[r]);
      column.y[r] = hn::IfThenElse(here, Columns::y_of(image, r), column.y[r]);
    }
    return column;
  }

  // Lane by lane `a` where the lane is long, else `b`.
  HWY_INLINE Column by_length(const Column& a, const Column& b) const {
    const auto is_long = hn::Gt(hn::Load(d, long_.data()), hn::Zero(d));
    Column chosen;
    for (int r = 0; r < R; ++r) {
      chosen.x[r] = hn::IfThenElse(is_long, a.x[r], b.x[r]);
      chosen.y[r] = hn::IfThenElse(is_long, a.y[r], b.y[r]);
    }
    return chosen;
  }

  // Puts x and vx of rings without stagger to zero in one lane of a column.
  static HWY_INLINE void put_on_axis(double* at, size_t lane) {
    const auto here = lane_is(lane);
    for (int r = 0; r < R; r += 2) {
      double* x = at + static_cast<size_t>(r) * L;
      double* vx = x + 2 * Columns::row;
      hn::Store(hn::IfThenZeroElse(here, hn::Load(d, x)), d, x);
      hn::Store(hn::IfThenZeroElse(here, hn::Load(d, vx)), d, vx);
    }
  }

  HWY_INLINE void fill_ghosts() {
    const double* const first[sent] = {column(0), column(1), column(2)};
    const double* const last[sent] = {column(last_), column(last_ - 1), column(last_ - 2)};
    Columns::store(before_first(first, last), before());
    Columns::store(behind_last(first, last), behind());
  }

  // One stage. As in RingLoop, what was moved last in the stage before is needed late.
  HWY_INLINE void pass(const Columns& physics, const Constants& c, const std::vector<Wall>& walls) {
    double* u = u_.data();
    double* u_first = u + chunk * Columns::terms;
    Column left;
    V lowest = Columns::high_up();
    fill_ghosts();
    for (size_t k = 1; k <= last_; k += chunk) {
      const size_t count = std::min(chunk, last_ + 1 - k);
      Columns::reciprocals(column(k), count, u);
      if (k == 1) {
        Columns::reciprocals(before(), 2, u_first);
        physics.template sums<Ending::drop>(c, before(), 1, u_first, left, lowest);
        physics.template sums<Ending::move>(c, column(0), 1, u_first + Columns::terms, left,
                                            lowest);
      }
      physics.template sums<Ending::move>(c, column(k), count, u, left, lowest);
    }
    Columns::meet_walls(c, walls, column(0), last_ + 1, lowest);
    mend_first(column(0));
    mend_last(column(last_));
  }

  std::int64_t half_;  // columns of half a ring
  size_t last_;        // K, the last column a lane computes
  AlignedArray data_;
  AlignedArray u_;
  AlignedArray long_;  // 1 in a long lane, 0 in a short one
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
