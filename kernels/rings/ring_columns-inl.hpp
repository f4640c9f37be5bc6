// One column of a ball of concentric rings, on vectors: where its particles stand, its bonds, how
// it moves. A column is the particles of all rings at one angle. The kernels ring and mirror sweep
// over such columns, one after another.
//
// Why it is built so
//  1. The work is arithmetic: 360 particles are 11.5 kB and stay in L1. So each bond is computed
//     once (Newton's third law), not twice as in the listing, and nothing is gathered by index.
//  2. Lane = sector. With L lanes and K columns a lane, lane l of vector k is column l K + k:
//
//         column:    0     1    ...   K-1 |  K    K+1  ...  2K-1 | ...
//         lane 0:  k=0   k=1        k=K-1 |                      |
//         lane 1:                         | k=0   k=1      k=K-1 | ...
//
//     The next column is the next vector, same lane; only behind k = K-1 stands vector 0 turned by
//     one lane. Vectors of one k lie side by side, a block of 4 R vectors:
//
//         x ring 0 .. R-1 | y ring 0 .. R-1 | vx ring 0 .. R-1 | vy ring 0 .. R-1
//
//  3. Two sweeps a stage: `reciprocals` takes 1/R^2 of each bond of some columns and leaves them in
//     L1; `sums` takes differences again, forces, sums, kick, drift and least height. What limits a
//     sweep is not the ports but how far the processor looks ahead: a column hangs together over
//     some 45 cycles (load, difference, square, product, division, products; then the force and
//     five sums one after the other), and its results fill half of the register file. Two short
//     sweeps keep two or three columns in flight, one long one hardly more than one: that took 98
//     cycles a column, the two take 60.
//  4. The differences are taken again rather than kept: two loads and a subtraction, on ports that
//     are free, for a store and two loads. Keeping them took 70 cycles.
//  5. The reciprocals of up to four squared distances share one division (multiply, divide once,
//     multiply back): IEEE operations only, so every machine gives the same bits.
//  6. Nothing is called within a sweep: a call in the loop, never taken, still made the compiler
//     keep everything in memory around it. So walls come after it (vector_walls-inl.hpp); within,
//     the least height is one minimum a particle.
//  7. One answer: the bonds that lead to a particle from the column on its left are summed on their
//     own, from the gravity kick on (its left sums); its other bonds are summed from its velocity
//     on; and the two sums are added once. That association, and the grouping of the reciprocals
//     (the bonds of one column), depend on the neighbourhood alone, never on where a lane, a tile
//     or a thread begins.
//
// Operations per column and vector, R = 3 rings, 7 bonds, law (3, 5):
//   a bond: 2 for R^2, 3 for F/R, 4 for the sums; 2 + 2 subtractions    63 mul/fma, 28 sub
//   the reciprocals: 9 + 6 multiplications, 2 divisions                 15 mul,      2 div
//   a particle: 1 addition and 1 fma each for x and y; 1 minimum         6 fma,      6 add, 3 min
// 84 multiplications: on two ports 42 cycles, 30 columns of vectors with 4 lanes, 15 with 8. (Where
// additions share these ports, as on Intel's, 60 cycles.)
//
// Cycles that are said to be taken, above and below, were seen on AMD Zen 3 with 4 lanes, in quiet
// minutes: 60 of them are 70 % of what its ports allow. The part that is reached elsewhere, and
// with 8 lanes, is the column "port limit" of results/throughput.md.
//
// Not taken: an approximate reciprocal with Newton steps (as fast, other bits on other makers'
// processors); particles of one ring side by side in a vector (unaligned loads, and sums that
// overlap between vectors); F/R instead of 1/R^2 in the first sweep (70 cycles: it is the longer
// chain already); the first sweep one column ahead within the second (65 cycles, and twice the
// code).
#if defined(BOUNCE_RING_COLUMNS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_COLUMNS_INL_HPP
#undef BOUNCE_RING_COLUMNS_INL_HPP
#else
#define BOUNCE_RING_COLUMNS_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <utility>

#include "kernels/rings/ring_shape.hpp"
#include "kernels/stepping/staged_stepper.hpp"
#include "kernels/stepping/vector_law-inl.hpp"
#include "kernels/stepping/vector_walls-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#define BOUNCE_UNROLL _Pragma("GCC unroll 16")

inline constexpr int most_in_group = 4;  // bonds that share a division

template <class V>
HWY_INLINE V one_of() {
  return hn::Set(hn::DFromV<V>(), 1.0);
}

/// Reciprocals of N values by one division.
template <int N, class V>
HWY_INLINE void reciprocals_of(const V* r2, V* u) {
  static_assert(N <= most_in_group);
  if constexpr (N == 4) {
    const V ab = hn::Mul(r2[0], r2[1]), cd = hn::Mul(r2[2], r2[3]);
    const V one_over = hn::Div(one_of<V>(), hn::Mul(ab, cd));
    const V over_ab = hn::Mul(one_over, cd), over_cd = hn::Mul(one_over, ab);
    u[0] = hn::Mul(over_ab, r2[1]);
    u[1] = hn::Mul(over_ab, r2[0]);
    u[2] = hn::Mul(over_cd, r2[3]);
    u[3] = hn::Mul(over_cd, r2[2]);
  } else if constexpr (N == 3) {
    const V ab = hn::Mul(r2[0], r2[1]);
    const V one_over = hn::Div(one_of<V>(), hn::Mul(ab, r2[2]));
    const V over_ab = hn::Mul(one_over, r2[2]);
    u[0] = hn::Mul(over_ab, r2[1]);
    u[1] = hn::Mul(over_ab, r2[0]);
    u[2] = hn::Mul(one_over, ab);
  } else if constexpr (N == 2) {
    const V one_over = hn::Div(one_of<V>(), hn::Mul(r2[0], r2[1]));
    u[0] = hn::Mul(one_over, r2[1]);
    u[1] = hn::Mul(one_over, r2[0]);
  } else {
    u[0] = hn::Div(one_of<V>(), r2[0]);
  }
}

/// D: Highway's tag with the lanes to use. Law: the form the scene needs. R: rings.
template <class D, class Law, int R>
class RingColumns {
 public:
  using Tag = D;
  using V = hn::Vec<D>;
  static constexpr D d{};
  static constexpr size_t L = hn::MaxLanes(D());
  static constexpr int rings = R;
  static constexpr size_t row = size_t{R} * L;  // numbers of x of a column
  static constexpr size_t positions = 2 * row;  // numbers of x and y
  static constexpr size_t block = 4 * row;
  static constexpr int bonds_a_column = 3 * R - 2;
  static constexpr size_t terms = size_t{bonds_a_column} * L;  // of a column's reciprocals

  /// Bond b of a column goes from ring `from` at this column to ring `to`, at this or the next one.
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

  /// Positions of one column, or sums on one.
  struct Column {
    V x[R], y[R];
  };

  /// A stage's constants, a vector each: they are read as memory operands. Aligned by hand: a
  /// standard container compiles its allocation for the file's target, not for this one, and would
  /// give vectors of eight the alignment of vectors of four.
  struct alignas(64) Constants {
    V attraction[bonds_a_column], repulsion[bonds_a_column];
    V gx, gy, drift;
  };

  /// What becomes of the sums that were taken from the velocities of a column on.
  enum class Ending {
    move,  ///< its left sums are known: they are added, and its particles drift
    keep,  ///< its left sums come later: until then they wait in the place of the velocities
    drop   ///< it is another tile's column: only the left sums of the column behind it are wanted
  };

  RingColumns(RingShape shape, PairLaw law) : shape_(std::move(shape)), law_(law) {}

  [[nodiscard]] Constants make_constants(const StageConstants& stage) const {
    Constants c;
    for (int bond = 0; bond < bonds_a_column; ++bond) {
      const BondClass& kick = stage.kick[static_cast<size_t>(bond_class(bond))];
      c.attraction[bond] = hn::Set(d, kick.attraction);
      c.repulsion[bond] = hn::Set(d, kick.repulsion);
    }
    c.gx = hn::Set(d, stage.gravity.x);
    c.gy = hn::Set(d, stage.gravity.y);
    c.drift = hn::Set(d, stage.drift);
    return c;
  }

  /// The class of bond b of a column.
  [[nodiscard]] int bond_class(int b) const {
    if (b < R) return shape_.along[static_cast<size_t>(b)];
    const auto inner = static_cast<size_t>((b - R) / 2);
    return (b - R) % 2 == 0 ? shape_.same[inner] : shape_.diagonal[inner];
  }

  /// x and y of ring r of the column at `at`.
  static HWY_INLINE V x_of(const double* at, int r) {
    return hn::Load(d, at + static_cast<size_t>(r) * L);
  }
  static HWY_INLINE V y_of(const double* at, int r) {
    return hn::Load(d, at + row + static_cast<size_t>(r) * L);
  }

  static HWY_INLINE Column load(const double* at) {
    Column column;
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
      column.x[r] = x_of(at, r);
      column.y[r] = y_of(at, r);
    }
    return column;
  }
  static HWY_INLINE void store(const Column& column, double* at) {
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
      hn::Store(column.x[r], d, at + static_cast<size_t>(r) * L);
      hn::Store(column.y[r], d, at + row + static_cast<size_t>(r) * L);
    }
  }

  /// Lane l gets the value of lane l + shift: +1 turns vector 0 into what stands behind vector
  /// K - 1, and -1 turns vector K - 1 into what stands before vector 0.
  static HWY_INLINE Column turn(const Column& column, int shift) {
    if constexpr (L == 1) {
      return column;
    } else {
      HWY_ALIGN std::int64_t lanes[L];
      for (size_t l = 0; l < L; ++l) {
        lanes[l] = static_cast<std::int64_t>((l + L + static_cast<size_t>(shift)) % L);
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

  /// First sweep: 1/R^2 of the bonds of `columns` columns, from `at` on, into u. Behind the last
  /// one the next column's positions must stand.
  static HWY_INLINE void reciprocals(const double* at, size_t columns, double* u) {
    Column here = load(at);
    for (; columns > 0; --columns, u += terms) {
      at += block;
      const Column next = load(at);
      group_reciprocals<0>(here, next, u);
      here = next;
    }
  }

  /// Second sweep, over the same columns. `left` comes with the left sums of the first column and
  /// goes with those of the column behind the last. `lowest` becomes the least of itself and of all
  /// heights that are numbers.
  template <Ending ending>
  HWY_INLINE void sums(const Constants& c, double* at, size_t columns, const double* u,
                       Column& left, V& lowest) const {
    for (; columns > 0; --columns, at += block, u += terms) {
      Column from_velocity, on_next;
      ring_sums<0, ending>(c, at, u, from_velocity, left, on_next, lowest);
      left = on_next;
    }
  }

  /// Kick and drift of a column whose sums from the velocity on were kept.
  HWY_INLINE void finish_kept(const Constants& c, double* at, const Column& left, V& lowest) const {
    const Column kept = load(at + positions);
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) finish(c, at, r, kept, left, lowest);
  }

  /// `lowest` before the first column.
  static HWY_INLINE V high_up() { return hn::Set(d, hwy::HighestValue<double>()); }

  /// After the sweeps: mirrors what stands behind a wall. `lowest`: of these columns.
  static HWY_INLINE void meet_walls(const Constants& c, const std::vector<Wall>& walls, double* at,
                                    size_t columns, V lowest) {
    const auto place = [at](size_t k, size_t j) {
      const double* x = at + (2 * k + j / R) * block + j % R * L;
      return Place{x, x + row};
    };
    const size_t pairs = columns / 2;
    const auto odd_one = [=](size_t, size_t r) { return place(pairs, r); };
    for (const Wall& wall : walls) {
      const bool clear = is_floor(wall) ? above(d, wall, lowest)
                                        : in_front<2 * size_t{R}>(d, wall, pairs, place) &&
                                              in_front<size_t{R}>(d, wall, columns % 2, odd_one);
      if (HWY_UNLIKELY(!clear)) return mirror_columns(c, walls, at, columns);
    }
  }

 private:
  // Numbers of the bonds of a column.
  static constexpr int along(int ring) { return ring; }
  static constexpr int same(int inner) { return R + 2 * inner; }
  static constexpr int diagonal(int inner) { return R + 2 * inner + 1; }

  // Bonds first, first + 1, ... of a column share a division, most_in_group of them.
  template <int first>
  static HWY_INLINE void group_reciprocals(const Column& here, const Column& next, double* u) {
    constexpr int count = std::min(most_in_group, bonds_a_column - first);
    V r2[count], over[count];
    BOUNCE_UNROLL for (int i = 0; i < count; ++i) {
      const BondPlace p = place(first + i);
      const Column& other = p.next ? next : here;
      const V dx = hn::Sub(here.x[p.from], other.x[p.to]);
      const V dy = hn::Sub(here.y[p.from], other.y[p.to]);
      r2[i] = hn::MulAdd(dy, dy, hn::Mul(dx, dx));
    }
    reciprocals_of<count>(r2, over);
    BOUNCE_UNROLL for (int i = 0; i < count; ++i) {
      hn::Store(over[i], d, u + static_cast<size_t>(first + i) * L);
    }
    if constexpr (first + count < bonds_a_column) {
      group_reciprocals<first + count>(here, next, u);
    }
  }

  // Bond b: adds to `sums` what acts on the column at `at`, to `on_next` what acts on the next one.
  template <int b>
  HWY_INLINE void bond(const Constants& c, const double* at, const double* u, Column& sums,
                       Column& on_next) const {
    constexpr BondPlace p = place(b);
    const double* to = p.next ? at + block : at;
    const V dx = hn::Sub(x_of(at, p.from), x_of(to, p.to));
    const V dy = hn::Sub(y_of(at, p.from), y_of(to, p.to));
    const V over = hn::Load(d, u + static_cast<size_t>(b) * L);
    const V f = law_.force_over_distance(d, over, c.attraction[b], c.repulsion[b]);
    sums.x[p.from] = hn::MulAdd(f, dx, sums.x[p.from]);
    sums.y[p.from] = hn::MulAdd(f, dy, sums.y[p.from]);
    // The bond along a ring is the first from the left: it starts that sum, from the gravity kick.
    Column& on = p.next ? on_next : sums;
    on.x[p.to] = hn::NegMulAdd(f, dx, b < R ? c.gx : on.x[p.to]);
    on.y[p.to] = hn::NegMulAdd(f, dy, b < R ? c.gy : on.y[p.to]);
  }

  template <int r>
  HWY_INLINE void start_ring(const Constants& c, const double* at, const double* u, Column& sums,
                             Column& on_next) const {
    sums.x[r] = x_of(at + positions, r);
    sums.y[r] = y_of(at + positions, r);
    bond<along(r)>(c, at, u, sums, on_next);
  }

  template <Ending ending>
  HWY_INLINE void end_ring(const Constants& c, double* at, int r, const Column& sums,
                           const Column& left, V& lowest) const {
    if constexpr (ending == Ending::move) {
      finish(c, at, r, sums, left, lowest);
    } else if constexpr (ending == Ending::keep) {
      hn::Store(sums.x[r], d, at + positions + static_cast<size_t>(r) * L);
      hn::Store(sums.y[r], d, at + positions + row + static_cast<size_t>(r) * L);
    }
  }

  // The bonds from ring to ring outwards: a ring is finished when its last bond is summed, so few
  // sums are alive at a time. Along, same, diagonal of each pair of rings: the order of the numbers
  // for each particle.
  template <int ring, Ending ending>
  HWY_INLINE void ring_sums(const Constants& c, double* at, const double* u, Column& sums,
                            const Column& left, Column& on_next, V& lowest) const {
    if constexpr (ring == 0) start_ring<0>(c, at, u, sums, on_next);
    if constexpr (ring + 1 < R) {
      start_ring<ring + 1>(c, at, u, sums, on_next);
      bond<same(ring)>(c, at, u, sums, on_next);
      bond<diagonal(ring)>(c, at, u, sums, on_next);
    }
    end_ring<ending>(c, at, ring, sums, left, lowest);
    if constexpr (ring + 1 < R) {
      ring_sums<ring + 1, ending>(c, at, u, sums, left, on_next, lowest);
    }
  }

  HWY_INLINE void finish(const Constants& c, double* at, int ring, const Column& sums,
                         const Column& left, V& lowest) const {
    double* const in_ring = at + static_cast<size_t>(ring) * L;
    move(c.drift, hn::Add(sums.x[ring], left.x[ring]), in_ring);
    const V y = move(c.drift, hn::Add(sums.y[ring], left.y[ring]), in_ring + row);
    lowest = hn::Min(y, lowest);
  }

  // One coordinate of a particle: `at` its place, v its new velocity. Returns the coordinate.
  static HWY_INLINE V move(V drift, V v, double* at) {
    const V x = hn::MulAdd(drift, v, hn::Load(d, at));
    hn::Store(v, d, at + positions);
    hn::Store(x, d, at);
    return x;
  }

  static HWY_NOINLINE void mirror_columns(const Constants& c, const std::vector<Wall>& walls,
                                          double* at, size_t columns) {
    for (; columns > 0; --columns, at += block) {
      for (int r = 0; r < R; ++r) {
        double* x = at + static_cast<size_t>(r) * L;
        bounce::HWY_NAMESPACE::meet_walls(d, walls, c.drift, x, x + row, x + 2 * row, x + 3 * row);
      }
    }
  }

  RingShape shape_;
  Law law_;
};

#undef BOUNCE_UNROLL

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
