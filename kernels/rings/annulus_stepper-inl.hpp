// annulus: concentric rings, as many as there are, a number known only at run time: for balls of
// more rings than `ring` is compiled for.
//
// Why it is built so (ring_columns-inl.hpp says why a lane is a sector of the ball, and draws it)
//  1. A column, the particles of all rings at one angle, is swept ring by ring outwards. Ring r
//     brings three bonds, all that lead on from it: along the ring to the next column, and the two
//     to ring r + 1, one of which leads to the next column, too:
//
//         r even:   r --- r'    r --- r + 1    r' --- r + 1      r' = ring r of the next column
//         r odd:    r --- r'    r --- r + 1    r  --- (r + 1)'
//
//     They share one division. Two parities, two bodies: no branch within.
//  2. What is carried from ring to ring fits in registers: positions of ring r + 1 here and in the
//     next column, and its two sums as far as they are known. What is carried from column to column
//     is an array, the sums of the bonds that lead there (the left sums of the next column): two
//     vectors a ring.
//  3. The numbers of a particle stand together, x y vx vy, a vector each: a column is one stream,
//     in place; when ring r's bonds are summed nobody needs its old place any more.
//  4. A thread has a tile, some neighbouring columns. It keeps copies of the columns beside it,
//     takes the left sums of its first column itself, and sends its own outer columns at the end of
//     the stage, for even and odd stages apart: so threads meet once a stage.
//  5. One answer: order of the sums and grouping of the divisions depend on ring and parity alone.
//     (They are others than `ring`'s, so the two differ by rounding.)
//
// Operations a ring and vector, law (3, 5): 6 for R^2, 6 to share the division, 9 for F/R, 12 for
// the sums, 2 drifts: 35 multiplications and multiply-adds, 8 subtractions and additions.
//
// Not taken: several stages while a column is in cache, as tiles of `ring` do. A column of 100
// rings is 13 kB with 4 lanes: columns for 16 stages would not stay in L1, and an annulus of 72 000
// particles (2.3 MB) stays in the last-level cache anyway. A ball beyond that cache is swept
// through memory once a stage.
#if defined(BOUNCE_ANNULUS_STEPPER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_ANNULUS_STEPPER_INL_HPP
#undef BOUNCE_ANNULUS_STEPPER_INL_HPP
#else
#define BOUNCE_ANNULUS_STEPPER_INL_HPP
#endif

#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/rings/ring_columns-inl.hpp"
#include "kernels/rings/ring_shape.hpp"
#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/staged_stepper.hpp"
#include "kernels/stepping/threads.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// D: Highway's tag with the lanes to use. Law: the form the scene needs. Two rings at least.
template <class D, class Law>
class AnnulusStepper final : public StagedStepper {
  using V = hn::Vec<D>;
  static constexpr D d{};
  static constexpr size_t L = hn::MaxLanes(D());
  static constexpr size_t step = 4 * L;  // doubles of a ring of a column: x, y, vx, vy

 public:
  AnnulusStepper(const Problem& start, RingShape shape, int threads)
      : StagedStepper(start),
        shape_(std::move(shape)),
        law_(start.law),
        rings_(static_cast<size_t>(shape_.rings)),
        columns_(static_cast<size_t>(shape_.per_ring) / L),
        data_(columns_ * rings_ * step) {
    const auto tiles = static_cast<size_t>(threads);
    for (size_t t = 0; t < tiles; ++t) {
      tiles_.emplace_back(columns_ * t / tiles, columns_ * (t + 1) / tiles, rings_);
    }
    AnnulusStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<Constants> constants;
    for (const StageConstants& stage : stages) constants.push_back(make_constants(stage));
    const std::int64_t passes = steps * static_cast<std::int64_t>(constants.size());
    for (Tile& tile : tiles_) send(tile, 0);
    std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(static_cast <int>(tiles_.size()))
    {
      // OpenMP may give fewer threads than asked for: then a thread has several tiles.
      const auto team = static_cast<size_t>(omp_get_num_threads());
      const auto me = static_cast<size_t>(omp_get_thread_num());
#pragma omp single
      barrier.emplace(static_cast<int>(team));
      for (std::int64_t n = 0; n < passes; ++n) {
        const Constants& c = constants[static_cast<size_t>(n) % constants.size()];
        for (size_t t = me; t < tiles_.size(); t += team) {
          pass(c, t, static_cast<size_t>(n & 1));
          send(tiles_[t], static_cast<size_t>((n + 1) & 1));
        }
        barrier->meet(n + 1);
      }
    }
  }

  void read(State& state) const override {
    for_each_place(data_.data(), state, [](double& value, double place) { value = place; });
  }

  void write(const State& state) override {
    for_each_place(data_.data(), state, [](double value, double& place) { place = value; });
  }

 private:
  // Of the three bonds of a ring, and of the stage.
  struct RingConstants {
    double attraction[3], repulsion[3];  // along, same, diagonal
  };
  struct Constants {
    std::vector<RingConstants> rings;
    double gx, gy, drift;
  };

  // Columns begin .. end - 1; copies of the columns beside them; the left sums of the next column;
  // what is sent to the neighbours, for even and odd stages.
  struct Tile {
    size_t begin, end;
    AlignedArray before, behind, left;
    std::array<AlignedArray, 2> first, last;

    Tile(size_t from, size_t to, size_t rings)
        : begin(from),
          end(to),
          before(rings * step),
          behind(rings * step),
          left(rings * 2 * L),
          first{AlignedArray(rings * step), AlignedArray(rings * step)},
          last{AlignedArray(rings * step), AlignedArray(rings * step)} {}
  };

  [[nodiscard]] double* column(size_t k) { return data_.data() + k * rings_ * step; }

  [[nodiscard]] Constants make_constants(const StageConstants& stage) const {
    Constants c{std::vector<RingConstants>(rings_), stage.gravity.x, stage.gravity.y, stage.drift};
    for (size_t r = 0; r < rings_; ++r) {
      const auto set = [&](size_t bond, int bond_class) {
        const BondClass& kick = stage.kick[static_cast<size_t>(bond_class)];
        c.rings[r].attraction[bond] = kick.attraction;
        c.rings[r].repulsion[bond] = kick.repulsion;
      };
      set(0, shape_.along[r]);
      if (r + 1 == rings_) break;
      set(1, shape_.same[r]);
      set(2, shape_.diagonal[r]);
    }
    return c;
  }

  // Sends the neighbours this tile's outer columns.
  void send(Tile& tile, size_t parity) {
    std::copy_n(column(tile.begin), rings_ * step, tile.first[parity].data());
    std::copy_n(column(tile.end - 1), rings_ * step, tile.last[parity].data());
  }

  // A neighbour's column, turned by `shift` lanes across the seam.
  HWY_INLINE void take(const AlignedArray& from, int shift, AlignedArray& to) const {
    for (size_t at = 0; at < rings_ * step; at += L) {
      for (size_t l = 0; l < L; ++l) {
        to[at + l] = from[at + (l + L + static_cast<size_t>(shift)) % L];
      }
    }
  }

  // One stage of tile t.
  HWY_INLINE void pass(const Constants& c, size_t t, size_t parity) {
    const size_t tiles = tiles_.size();
    Tile& tile = tiles_[t];
    take(tiles_[(t + tiles - 1) % tiles].last[parity], t == 0 ? -1 : 0, tile.before);
    take(tiles_[(t + 1) % tiles].first[parity], t + 1 == tiles ? 1 : 0, tile.behind);
    sweep_column<false>(c, tile.before.data(), column(tile.begin), tile.left.data());
    for (size_t k = tile.begin; k < tile.end; ++k) {
      double* here = column(k);
      const double* next = k + 1 < tile.end ? column(k + 1) : tile.behind.data();
      sweep_column<true>(c, here, next, tile.left.data());
      if (HWY_UNLIKELY(!in_front(here))) mirror_column(c, here);
    }
  }

  // What is carried from ring to ring: its places here and in the next column, the sum from its
  // velocity on, and the left sum of its particle in the next column.
  struct Carried {
    V x, y, next_x, next_y, sum_x, sum_y, on_next_x, on_next_y;
  };

  struct Bond {
    V dx, dy, r2;
    HWY_INLINE Bond(V x, V y, V to_x, V to_y)
        : dx(hn::Sub(x, to_x)), dy(hn::Sub(y, to_y)), r2(hn::MulAdd(dy, dy, hn::Mul(dx, dx))) {}
  };

  // All bonds that lead on from the particles of a column. `left` comes with its left sums and goes
  // with those of the next column. With `moves` the column is moved; without, it is another tile's
  // and only the left sums of the next column are wanted.
  template <bool moves>
  HWY_INLINE void sweep_column(const Constants& c, double* here, const double* next,
                               double* left) const {
    Carried now;
    start(c, here, next, now);
    size_t r = 0;
    for (; r + 2 < rings_; r += 2) {
      sweep_ring<0, moves>(c, r, here, next, left, now);
      sweep_ring<1, moves>(c, r + 1, here, next, left, now);
    }
    if (r + 1 < rings_) sweep_ring<0, moves>(c, r++, here, next, left, now);
    const Bond along(now.x, now.y, now.next_x, now.next_y);
    V u;
    reciprocals_of<1>(&along.r2, &u);
    add_along(c, r, along, u, now);
    finish<moves>(c, r, here, left, now);
  }

  static HWY_INLINE void load_ring(const double* here, const double* next, Carried& to) {
    to.x = hn::Load(d, here);
    to.y = hn::Load(d, here + L);
    to.next_x = hn::Load(d, next);
    to.next_y = hn::Load(d, next + L);
    to.sum_x = hn::Load(d, here + 2 * L);
    to.sum_y = hn::Load(d, here + 3 * L);
  }

  static HWY_INLINE void start(const Constants& c, const double* here, const double* next,
                               Carried& now) {
    load_ring(here, next, now);
    now.on_next_x = hn::Set(d, c.gx);
    now.on_next_y = hn::Set(d, c.gy);
  }

  HWY_INLINE V force(const Constants& c, size_t r, int bond, V u) const {
    return law_.force_over_distance(d, u, hn::Set(d, c.rings[r].attraction[bond]),
                                    hn::Set(d, c.rings[r].repulsion[bond]));
  }

  HWY_INLINE void add_along(const Constants& c, size_t r, const Bond& bond, V u,
                            Carried& now) const {
    const V f = force(c, r, 0, u);
    now.sum_x = hn::MulAdd(f, bond.dx, now.sum_x);
    now.sum_y = hn::MulAdd(f, bond.dy, now.sum_y);
    now.on_next_x = hn::NegMulAdd(f, bond.dx, now.on_next_x);
    now.on_next_y = hn::NegMulAdd(f, bond.dy, now.on_next_y);
  }

  // Ring r, of this parity, which is not the outermost.
  template <int parity, bool moves>
  HWY_INLINE void sweep_ring(const Constants& c, size_t r, double* here, const double* next,
                             double* left, Carried& now) const {
    Carried outer;
    load_ring(here + (r + 1) * step, next + (r + 1) * step, outer);
    outer.on_next_x = hn::Set(d, c.gx);
    outer.on_next_y = hn::Set(d, c.gy);
    const Bond along(now.x, now.y, now.next_x, now.next_y);
    const Bond same(now.x, now.y, outer.x, outer.y);
    const Bond diagonal = parity == 1 ? Bond(now.x, now.y, outer.next_x, outer.next_y)
                                      : Bond(outer.x, outer.y, now.next_x, now.next_y);
    const V r2[3] = {along.r2, same.r2, diagonal.r2};
    V u[3];
    reciprocals_of<3>(r2, u);
    add_along(c, r, along, u[0], now);
    const V f_same = force(c, r, 1, u[1]);
    now.sum_x = hn::MulAdd(f_same, same.dx, now.sum_x);
    now.sum_y = hn::MulAdd(f_same, same.dy, now.sum_y);
    outer.sum_x = hn::NegMulAdd(f_same, same.dx, outer.sum_x);
    outer.sum_y = hn::NegMulAdd(f_same, same.dy, outer.sum_y);
    const V f = force(c, r, 2, u[2]);
    Carried& from = parity == 1 ? now : outer;
    Carried& to = parity == 1 ? outer : now;
    from.sum_x = hn::MulAdd(f, diagonal.dx, from.sum_x);
    from.sum_y = hn::MulAdd(f, diagonal.dy, from.sum_y);
    to.on_next_x = hn::NegMulAdd(f, diagonal.dx, to.on_next_x);
    to.on_next_y = hn::NegMulAdd(f, diagonal.dy, to.on_next_y);
    finish<moves>(c, r, here, left, now);
    now = outer;
  }

  // Moves ring r, and leaves the left sum of the next column.
  template <bool moves>
  HWY_INLINE void finish(const Constants& c, size_t r, double* here, double* left,
                         const Carried& now) const {
    double* from_left = left + r * 2 * L;
    if constexpr (moves) {
      double* at = here + r * step;
      const V drift = hn::Set(d, c.drift);
      const V vx = hn::Add(now.sum_x, hn::Load(d, from_left));
      const V vy = hn::Add(now.sum_y, hn::Load(d, from_left + L));
      const V x = hn::MulAdd(drift, vx, now.x);
      const V y = hn::MulAdd(drift, vy, now.y);
      hn::Store(x, d, at);
      hn::Store(y, d, at + L);
      hn::Store(vx, d, at + 2 * L);
      hn::Store(vy, d, at + 3 * L);
    }
    hn::Store(now.on_next_x, d, from_left);
    hn::Store(now.on_next_y, d, from_left + L);
  }

  // Whether all particles of a column are in front of all walls.
  [[nodiscard]] HWY_INLINE bool in_front(const double* here) const {
    return all_in_front(d, model().walls, rings_, [here](size_t r) {
      const double* x = here + r * step;
      return Place{x, x + L};
    });
  }

  HWY_NOINLINE void mirror_column(const Constants& c, double* here) const {
    for (size_t r = 0; r < rings_; ++r) {
      double* x = here + r * step;
      meet_walls(d, model().walls, hn::Set(d, c.drift), x, x + L, x + 2 * L, x + 3 * L);
    }
  }

  // Calls visit(value in the state, its place in a column) for all numbers.
  template <class Number, class AnyState, class Visit>
  void for_each_place(Number* place, AnyState& state, Visit visit) const {
    const auto arrays = std::array{&state.x, &state.y, &state.vx, &state.vy};
    for (size_t k = 0; k < columns_; ++k) {
      for (size_t r = 0; r < rings_; ++r) {
        for (auto* array : arrays) {
          for (size_t l = 0; l < L; ++l) visit((*array)[(r * L + l) * columns_ + k], *place++);
        }
      }
    }
  }

  RingShape shape_;
  Law law_;
  size_t rings_, columns_;  // columns_: vectors a ring
  AlignedArray data_;
  std::vector<Tile> tiles_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
