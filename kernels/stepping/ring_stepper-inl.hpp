// ring: concentric rings with constant offsets, each bond once, all in registers.
//
// Why it is built so
//  1. The work is arithmetic: 360 particles are 11.5 kB and stay in L1. So each bond is computed
//  once
//     (Newton's third law), not twice as in the listing, and nothing is gathered.
//  2. Lane = sector. With L lanes and K = columns / L, lane l of vector k is column l K + k:
//
//         column:    0     1    ...   K-1 |  K    K+1  ...  2K-1 | ...
//         lane 0:  k=0   k=1        k=K-1 |                      |
//         lane 1:                         | k=0   k=1      k=K-1 | ...
//
//     The next column is the next vector, same lane; only behind k = K-1 stands vector 0 turned by
//     one lane. Vectors of one k lie side by side (x of all rings, y, vx, vy): a stream of 4R
//     vectors.
//  3. Columns stream through: at k the bonds within column k and from k to k + 1 are computed; the
//     sums on column k + 1 ("left") go on to the next pass, the positions loaded for k + 1 too.
//  4. Force, kick, drift and wall are one pass: a column is moved as soon as its last bond is
//  summed.
//     Column 0 waits for the end, when its left sum arrives from column K - 1.
//  5. The reciprocals of up to four squared distances share one division (multiply, divide once,
//     multiply back): IEEE operations only, so every machine gives the same bits.
//  6. One answer: a particle's left bonds are summed from the gravity kick on their own, the others
//     from its velocity, and the two are added once. That association, and the grouping of
//     the reciprocals (the bonds of one column), depend on the neighbourhood alone, never on where
//     a lane, a tile or a thread begins. A thread's tile computes the column before it once more,
//     just for its left sums.
//
// Operations per column and vector, R = 3 rings, 7 bonds, law (3, 5), one wall (counted in the
// compiled loop, the same for AVX2 and AVX-512):
//   a bond: 2 subtractions; 2 for R^2, 3 for F/R, 4 for the sums          63 mul/fma, 14 sub
//   the reciprocals: 9 + 6 multiplications, 2 divisions                   15 mul,      2 div
//   a particle: 1 addition and 1 fma each for x and y                      6 fma,      6 add
//   the floor: 3 comparisons, 2 ands, 1 test
// 84 on the multiply-add ports: on two of them 42 cycles, 30 columns of vectors with 4 lanes, 15
// with
// 8. GCC 12 adds some 28 spills and more reloads with 16 registers (AVX2), 10 with 32 (AVX-512).
//
// Not taken: an approximate reciprocal with Newton steps (as fast, other bits on other makers'
// processors); particles of one ring side by side in a vector (unaligned loads, and sums that
// overlap between vectors).
#if defined(BOUNCE_RING_STEPPER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_STEPPER_INL_HPP
#undef BOUNCE_RING_STEPPER_INL_HPP
#else
#define BOUNCE_RING_STEPPER_INL_HPP
#endif

#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/ring_shape.hpp"
#include "kernels/stepping/spin.hpp"
#include "kernels/stepping/staged_stepper.hpp"
#include "kernels/stepping/vector_law-inl.hpp"
#include "kernels/stepping/vector_walls-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#define BOUNCE_UNROLL _Pragma("GCC unroll 16")

inline constexpr int most_in_group = 4;  // bonds that share a division

/// Reciprocals of N values by one division.
template <int N, class V>
HWY_INLINE void reciprocals(const V* r2, V* u) {
  static_assert(N <= most_in_group);
  if constexpr (N == 4) {
    const V ab = hn::Mul(r2[0], r2[1]), cd = hn::Mul(r2[2], r2[3]);
    const V one_over = hn::Div(hn::Set(hn::DFromV<V>(), 1.0), hn::Mul(ab, cd));
    const V over_ab = hn::Mul(one_over, cd), over_cd = hn::Mul(one_over, ab);
    u[0] = hn::Mul(over_ab, r2[1]);
    u[1] = hn::Mul(over_ab, r2[0]);
    u[2] = hn::Mul(over_cd, r2[3]);
    u[3] = hn::Mul(over_cd, r2[2]);
  } else if constexpr (N == 3) {
    const V ab = hn::Mul(r2[0], r2[1]);
    const V one_over = hn::Div(hn::Set(hn::DFromV<V>(), 1.0), hn::Mul(ab, r2[2]));
    const V over_ab = hn::Mul(one_over, r2[2]);
    u[0] = hn::Mul(over_ab, r2[1]);
    u[1] = hn::Mul(over_ab, r2[0]);
    u[2] = hn::Mul(one_over, ab);
  } else if constexpr (N == 2) {
    const V one_over = hn::Div(hn::Set(hn::DFromV<V>(), 1.0), hn::Mul(r2[0], r2[1]));
    u[0] = hn::Mul(one_over, r2[1]);
    u[1] = hn::Mul(one_over, r2[0]);
  } else {
    u[0] = hn::Div(hn::Set(hn::DFromV<V>(), 1.0), r2[0]);
  }
}

/// D: Highway's tag with the lanes to use. Law, Walls: the form the scene needs. R: rings.
template <class D, class Law, class Walls, int R>
class RingStepper final : public StagedStepper {
  using V = hn::Vec<D>;
  static constexpr D d{};
  static constexpr size_t L = hn::MaxLanes(D());
  static constexpr size_t block = 4 * R * L;  // doubles a vector column
  static constexpr int bonds_a_column = 3 * R - 2;

 public:
  RingStepper(const Problem& start, const RingShape& shape, int threads)
      : StagedStepper(start),
        shape_(shape),
        law_(start.law),
        columns_(static_cast<size_t>(shape.per_ring) / L),
        threads_(threads),
        data_(columns_ * block) {
    RingStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<Constants> constants;
    for (const StageConstants& stage : stages) constants.push_back(make_constants(stage));
    if (threads_ > 1) {
      run_team(constants, steps);
      return;
    }
    const Walls walls(problem().walls);
    for (std::int64_t s = 0; s < steps; ++s) {
      for (const Constants& c : constants) pass(c, walls);
    }
  }

  void read(State& state) const override {
    for (size_t k = 0; k < columns_; ++k) {
      for (size_t row = 0; row < 4 * R; ++row) {
        for (size_t l = 0; l < L; ++l) {
          array(state, row / R)[(row % R) * columns_ * L + l * columns_ + k] =
              data_[k * block + row * L + l];
        }
      }
    }
  }

  void write(const State& state) override {
    State copy = state;
    for (size_t k = 0; k < columns_; ++k) {
      for (size_t row = 0; row < 4 * R; ++row) {
        for (size_t l = 0; l < L; ++l) {
          data_[k * block + row * L + l] =
              array(copy, row / R)[(row % R) * columns_ * L + l * columns_ + k];
        }
      }
    }
  }

 private:
  // Positions of one column, or sums on one.
  struct Column {
    V x[R], y[R];
  };

  // A stage's constants, a vector each: they are read as memory operands. Aligned by hand: a
  // standard container compiles its allocation for the file's target, not for this one, and would
  // give vectors of eight the alignment of vectors of four.
  struct alignas(64) Constants {
    V attraction[bonds_a_column], repulsion[bonds_a_column];
    V gx, gy, drift;
  };

  // What a thread tells its neighbours: the outer columns of its tile, for even and odd passes.
  struct alignas(64) Mailbox {
    std::atomic<std::int64_t> passes{-1};
    AlignedArray first[2], last[2];
  };

  static std::vector<double>& array(State& state, size_t which) {
    return which == 0 ? state.x : which == 1 ? state.y : which == 2 ? state.vx : state.vy;
  }

  // Bonds are numbered along ring 0 .. R-1, then same and diagonal of each pair of rings.
  Constants make_constants(const StageConstants& stage) const {
    Constants c;
    const auto set = [&](int bond, int bond_class) HWY_ATTR {
      const BondClass& kick = stage.kick[static_cast<size_t>(bond_class)];
      c.attraction[bond] = hn::Set(d, kick.attraction);
      c.repulsion[bond] = hn::Set(d, kick.repulsion);
    };
    for (int r = 0; r < R; ++r) {
      const auto ring = static_cast<size_t>(r);
      set(r, shape_.along[ring]);
      if (r + 1 == R) break;
      set(R + 2 * r, shape_.same[ring]);
      set(R + 2 * r + 1, shape_.diagonal[ring]);
    }
    c.gx = hn::Set(d, stage.gravity.x);
    c.gy = hn::Set(d, stage.gravity.y);
    c.drift = hn::Set(d, stage.drift);
    return c;
  }

  static HWY_INLINE Column load(const double* at) {
    Column column;
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
      column.x[r] = hn::Load(d, at + static_cast<size_t>(r) * L);
      column.y[r] = hn::Load(d, at + static_cast<size_t>(R + r) * L);
    }
    return column;
  }
  static HWY_INLINE void store(const Column& column, double* at) {
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
      hn::Store(column.x[r], d, at + static_cast<size_t>(r) * L);
      hn::Store(column.y[r], d, at + static_cast<size_t>(R + r) * L);
    }
  }

  // Lane l gets lane l + shift's value: +1 turns column 0 into column K, -1 the other way round.
  static HWY_INLINE Column turn(const Column& column, int shift) {
    if constexpr (L == 1) {
      return column;
    } else {
      HWY_ALIGN int64_t lanes[L];
      for (size_t l = 0; l < L; ++l) {
        lanes[l] = static_cast<int64_t>((l + L + static_cast<size_t>(shift)) % L);
      }
      const auto indices = hn::SetTableIndices(d, lanes);
      Column turned;
      BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
        turned.x[r] = hn::TableLookupLanes(column.x[r], indices);
        turned.y[r] = hn::TableLookupLanes(column.y[r], indices);
      }
      return turned;
    }
  }

  // Bond b of a column goes from ring `from` at this column to ring `to`, at this or the next one.
  struct BondPlace {
    int from, to;
    bool next;
  };
  static constexpr BondPlace place(int b) {
    if (b < R) return {b, b, true};
    const int inner = (b - R) / 2;
    if ((b - R) % 2 == 0) return {inner, inner + 1, false};
    return inner % 2 == 1 ? BondPlace{inner, inner + 1, true} : BondPlace{inner + 1, inner, true};
  }

  // Bonds `first` to `last` - 1 of column `here`, which share a division.
  template <int first, int last>
  HWY_INLINE void bond_group(const Constants& c, const Column& here, const Column& next,
                             Column& rest, Column& left) const {
    constexpr int count = last - first;
    V dx[count], dy[count], r2[count], u[count];
    BOUNCE_UNROLL for (int i = 0; i < count; ++i) {
      const BondPlace p = place(first + i);
      dx[i] = hn::Sub(here.x[p.from], p.next ? next.x[p.to] : here.x[p.to]);
      dy[i] = hn::Sub(here.y[p.from], p.next ? next.y[p.to] : here.y[p.to]);
      r2[i] = hn::MulAdd(dy[i], dy[i], hn::Mul(dx[i], dx[i]));
    }
    reciprocals<count>(r2, u);
    BOUNCE_UNROLL for (int i = 0; i < count; ++i) {
      const int b = first + i;
      const BondPlace p = place(b);
      const V f = law_.force_over_distance(d, u[i], c.attraction[b], c.repulsion[b]);
      rest.x[p.from] = hn::MulAdd(f, dx[i], rest.x[p.from]);
      rest.y[p.from] = hn::MulAdd(f, dy[i], rest.y[p.from]);
      // The bond along a ring is the first from the left: it starts that sum, from the gravity
      // kick.
      Column& on = p.next ? left : rest;
      on.x[p.to] = hn::NegMulAdd(f, dx[i], b < R ? c.gx : on.x[p.to]);
      on.y[p.to] = hn::NegMulAdd(f, dy[i], b < R ? c.gy : on.y[p.to]);
    }
  }

  // All bonds of column `here`: adds to `rest` what acts on it, gives in `left` what acts on
  // `next`. Group by group, so that few of their vectors are alive at a time.
  template <int first = 0>
  HWY_INLINE void bonds(const Constants& c, const Column& here, const Column& next, Column& rest,
                        Column& left) const {
    constexpr int last = std::min(first + most_in_group, bonds_a_column);
    bond_group<first, last>(c, here, next, rest, left);
    if constexpr (last < bonds_a_column) bonds<last>(c, here, next, rest, left);
  }

  // Kick, drift and wall of a column whose sums are complete.
  HWY_INLINE void move(const Constants& c, const Walls& walls, const Column& here,
                       const Column& rest, const Column& left, double* at) const {
    Column v, moved;
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
      v.x[r] = hn::Add(rest.x[r], left.x[r]);
      v.y[r] = hn::Add(rest.y[r], left.y[r]);
      moved.x[r] = hn::MulAdd(c.drift, v.x[r], here.x[r]);
      moved.y[r] = hn::MulAdd(c.drift, v.y[r], here.y[r]);
    }
    store(moved, at);
    store(v, at + 2 * R * L);
    if constexpr (Walls::any) {
      auto clear = walls.clear(d, moved.x[0], moved.y[0]);
      BOUNCE_UNROLL for (int r = 1; r < R; ++r) {
        clear = hn::And(clear, walls.clear(d, moved.x[r], moved.y[r]));
      }
      if (HWY_UNLIKELY(!hn::AllTrue(d, clear))) {
        reflect(d, walls.walls, at, at + R * L, at + 2 * R * L, at + 3 * R * L, R);
      }
    }
  }

  // Columns k .. end-1, each with its successor in the next block; `here` and `left` go along.
  HWY_INLINE void stream(const Constants& c, const Walls& walls, size_t k, size_t end, Column& here,
                         Column& left) {
    for (; k < end; ++k) {
      double* at = data_.data() + k * block;
      const Column next = load(at + block);
      Column rest = load(at + 2 * R * L), on_next;
      bonds(c, here, next, rest, on_next);
      move(c, walls, here, rest, left, at);
      here = next;
      left = on_next;
    }
  }

  // One stage of the whole ring by one thread.
  HWY_INLINE void pass(const Constants& c, const Walls& walls) {
    double* first = data_.data();
    double* last = first + (columns_ - 1) * block;
    Column here = load(first), left;
    {
      const Column next = load(first + block);
      Column rest = load(first + 2 * R * L);
      bonds(c, here, next, rest, left);
      store(rest, first + 2 * R * L);
      here = next;
    }
    stream(c, walls, 1, columns_ - 1, here, left);
    Column rest = load(last + 2 * R * L), on_first;
    bonds(c, here, turn(load(first), 1), rest, on_first);
    move(c, walls, here, rest, left, last);
    move(c, walls, load(first), load(first + 2 * R * L), turn(on_first, -1), first);
  }

  // Tells the neighbours where this tile's outer columns stand before pass number `pass`.
  void publish(Mailbox& box, size_t begin, size_t end, std::int64_t pass) {
    const auto parity = static_cast<size_t>(pass & 1);
    const size_t positions = 2 * R * L;
    std::copy_n(data_.data() + begin * block, positions, box.first[parity].data());
    std::copy_n(data_.data() + (end - 1) * block, positions, box.last[parity].data());
    box.passes.store(pass, std::memory_order_release);
  }

  // One stage of columns begin .. end-1 between two neighbours' tiles.
  HWY_INLINE void pass_tile(const Constants& c, const Walls& walls, size_t begin, size_t end,
                            const Mailbox& before, const Mailbox& after, std::int64_t pass) {
    const auto parity = static_cast<size_t>(pass & 1);
    wait_for(before.passes, pass);
    wait_for(after.passes, pass);
    Column previous = load(before.last[parity].data());
    if (begin == 0) previous = turn(previous, -1);
    Column beyond = load(after.first[parity].data());
    if (end == columns_) beyond = turn(beyond, 1);
    Column here = load(data_.data() + begin * block), left;
    Column unused = here;
    bonds(c, previous, here, unused, left);
    stream(c, walls, begin, end - 1, here, left);
    double* last = data_.data() + (end - 1) * block;
    Column rest = load(last + 2 * R * L);
    bonds(c, here, beyond, rest, unused);
    move(c, walls, here, rest, left, last);
  }

  void run_team(const std::vector<Constants>& constants, std::int64_t steps) {
    std::vector<Mailbox> boxes(static_cast<size_t>(threads_));
    for (Mailbox& box : boxes) {
      for (int parity = 0; parity < 2; ++parity) {
        box.first[parity] = AlignedArray(2 * R * L);
        box.last[parity] = AlignedArray(2 * R * L);
      }
    }
#pragma omp parallel num_threads(threads_)
    {
      // OpenMP may give fewer threads than asked for: the tiles follow what it gave.
      const auto team = static_cast<size_t>(omp_get_num_threads());
      const auto me = static_cast<size_t>(omp_get_thread_num());
      const size_t begin = columns_ * me / team, end = columns_ * (me + 1) / team;
      const Mailbox& before = boxes[(me + team - 1) % team];
      const Mailbox& after = boxes[(me + 1) % team];
      const Walls walls(problem().walls);
      std::int64_t done = 0;
      publish(boxes[me], begin, end, done);
      for (std::int64_t s = 0; s < steps; ++s) {
        for (const Constants& c : constants) {
          pass_tile(c, walls, begin, end, before, after, done);
          publish(boxes[me], begin, end, ++done);
        }
      }
    }
  }

  RingShape shape_;
  Law law_;
  size_t columns_;  // vectors a ring
  int threads_;
  AlignedArray data_;
};

#undef BOUNCE_UNROLL

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
