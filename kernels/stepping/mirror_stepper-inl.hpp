// mirror: half of a ball of rings that is left-right symmetric, by the sweeps of
// ring_columns-inl.hpp.
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
//  2. Lane l begins at column l half / L (rounded down) and computes columns 0 .. K of its own,
//     K = half / L rounded up, with a ghost at either side. The last lane needs its column K: it is
//     the particle on the axis below. In the other lanes it is their neighbour's column 0 (or 1, if
//     half / L is not whole and the lane is short), computed twice, to the same bits.
//  3. Before a stage the seams are mended: ghosts come from the neighbour lane, or from the mirror
//     image in the first and the last lane; particles on the axis are put back on it (x = 0, vx =
//     0), since the sums from left and right cancel but for rounding.
//  4. The bonds across the axis so need no code of their own.
//
// Operations: K + 1 columns and the left sums of one more, where the full ball has 2 half / L: with
// 4 lanes 17 columns instead of 30, with 8 lanes 10 instead of 15.
//
// Not taken: the two particles on the axis as scalars (K columns only, but their bonds, which sit
// in lanes of other columns, would have to be taken out one by one).
#if defined(BOUNCE_MIRROR_STEPPER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_MIRROR_STEPPER_INL_HPP
#undef BOUNCE_MIRROR_STEPPER_INL_HPP
#else
#define BOUNCE_MIRROR_STEPPER_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <vector>

#include "kernels/stepping/mirror_symmetry.hpp"
#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/ring_columns-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// D: Highway's tag with the lanes to use. Law, Walls: the form the scene needs. R: rings.
template <class D, class Law, class Walls, int R>
class MirrorStepper final : public StagedStepper {
  using Columns = RingColumns<D, Law, Walls, R>;
  using Column = typename Columns::Column;
  using Constants = typename Columns::Constants;
  using Rest = typename Columns::Rest;
  using V = hn::Vec<D>;
  static constexpr D d{};
  static constexpr size_t L = Columns::L;
  static constexpr size_t block = Columns::block;
  static constexpr size_t chunk = 32;  // columns whose reciprocals are kept

 public:
  /// `sum` as find_mirror_axis gives it; half the columns at least two a lane.
  MirrorStepper(const Problem& start, const RingShape& shape, std::int64_t sum)
      : StagedStepper(start),
        shape_(shape),
        sum_(sum),
        physics_(shape, start.law),
        last_((static_cast<size_t>(shape.per_ring) / 2 + L - 1) / L),
        data_((last_ + 3) * block),
        u_(Columns::terms * (chunk + 2)),
        long_(L) {
    for (size_t l = 0; l < L; ++l) {
      const bool is_short = begin_of(l + 1) - begin_of(l) < static_cast<std::int64_t>(last_);
      long_[l] = is_short ? 0.0 : 1.0;
    }
    MirrorStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<Constants> constants;
    for (const StageConstants& stage : stages) {
      constants.push_back(physics_.make_constants(stage));
    }
    const Walls walls(model().walls);
    for (std::int64_t s = 0; s < steps; ++s) {
      for (const Constants& c : constants) pass(c, walls);
    }
    mend_axis();
  }

  void read(State& state) const override {
    for_each_particle(
        0, static_cast<std::int64_t>(last_) + 1, [&](size_t place, int ring, std::int64_t q) {
          const bool beyond =
              2 * q + ring % 2 > shape_.per_ring;  // the image of one that stands here
          if (beyond) return;
          const double* at = data_.data() + place;
          const std::int64_t column = wrapped(q + sum_ / 2);
          put(state, ring, mirror_image(shape_, sum_, ring, column), 0.0 - at[0], at[Columns::row],
              0.0 - at[2 * Columns::row], at[3 * Columns::row]);
          put(state, ring, column, at[0], at[Columns::row], at[2 * Columns::row],
              at[3 * Columns::row]);
        });
  }

  void write(const State& state) override {
    if (const std::string why = not_symmetric(state, shape_, sum_); !why.empty()) {
      throw std::invalid_argument("the mirror kernel cannot take this state: " + why);
    }
    const auto ghosts = [&](size_t place, int ring, std::int64_t q) {
      double* at = data_.data() + place;
      const size_t i = index_of(ring, wrapped(q + sum_ / 2));
      at[0] = state.x[i];
      at[Columns::row] = state.y[i];
      at[2 * Columns::row] = state.vx[i];
      at[3 * Columns::row] = state.vy[i];
    };
    for_each_particle(-1, static_cast<std::int64_t>(last_) + 2, ghosts);
  }

 private:
  // Of the half, the column at which lane l begins.
  [[nodiscard]] std::int64_t begin_of(size_t l) const {
    return static_cast<std::int64_t>(l) * (shape_.per_ring / 2) / static_cast<std::int64_t>(L);
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

  // Calls visit(place of x in data_, ring, column from the axis above) for each lane of the
  // columns first .. end - 1.
  template <class Visit>
  void for_each_particle(std::int64_t first, std::int64_t end, Visit visit) const {
    for (std::int64_t k = first; k < end; ++k) {
      for (int ring = 0; ring < R; ++ring) {
        for (size_t l = 0; l < L; ++l) {
          const size_t place =
              static_cast<size_t>(k + 1) * block + static_cast<size_t>(ring) * L + l;
          visit(place, ring, begin_of(l) + k);
        }
      }
    }
  }

  [[nodiscard]] double* column(size_t k) { return data_.data() + (k + 1) * block; }
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

  HWY_INLINE void mend_axis() {
    put_on_axis(column(0), 0);
    put_on_axis(column(last_), L - 1);
  }

  // Ghosts, and the last lane's column K of staggered rings: images and neighbours' columns.
  HWY_INLINE void mend_seams() {
    mend_axis();
    const double* inner = column(last_ - 1);
    // In a short lane, whose neighbour begins one column sooner, columns count one higher.
    const Column previous =
        Columns::turn(by_length(Columns::load(inner), Columns::load(column(last_ - 2))), -1);
    Columns::store(with_image(previous, 0, column(1), column(0)), before());
    const Column next = by_length(Columns::turn(Columns::load(column(1)), 1),
                                  Columns::turn(Columns::load(column(2)), 1));
    Columns::store(with_image(next, L - 1, inner, column(last_ - 2)), behind());
    double* last = column(last_);
    const auto here = lane_is(L - 1);
    for (int r = 1; r < R; r += 2) {
      const V x = hn::IfThenElse(here, hn::Sub(hn::Zero(d), Columns::x_of(inner, r)),
                                 Columns::x_of(last, r));
      const V y = hn::IfThenElse(here, Columns::y_of(inner, r), Columns::y_of(last, r));
      hn::Store(x, d, last + static_cast<size_t>(r) * L);
      hn::Store(y, d, last + Columns::row + static_cast<size_t>(r) * L);
    }
  }

  // One stage. As in the ring kernel, what was moved last before is wanted late.
  HWY_INLINE void pass(const Constants& c, const Walls& walls) {
    double* u = u_.data();
    double* u_first = u + chunk * Columns::terms;
    V nearest = Columns::far_away();
    Column left;
    mend_seams();
    for (size_t k = 1; k <= last_; k += chunk) {
      const size_t count = std::min(chunk, last_ + 1 - k);
      Columns::reciprocals(column(k), count, u);
      if (k == 1) {
        Columns::reciprocals(before(), 2, u_first);
        physics_.template sums<Rest::drop>(c, walls, before(), 1, u_first, left, nearest);
        physics_.template sums<Rest::finish>(c, walls, column(0), 1, u_first + Columns::terms, left,
                                             nearest);
      }
      physics_.template sums<Rest::finish>(c, walls, column(k), count, u, left, nearest);
    }
    Columns::mirror_at_walls(walls, column(0), last_ + 1, nearest);
  }

  RingShape shape_;
  std::int64_t sum_;
  Columns physics_;
  size_t last_;  // K, the last column a lane computes
  AlignedArray data_;
  AlignedArray u_;
  AlignedArray long_;  // 1 in a lane of K columns, 0 in one of K - 1
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
