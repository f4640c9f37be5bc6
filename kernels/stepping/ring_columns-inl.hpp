// One column of concentric rings, in vectors: where it stands, its bonds, how it moves. The kernels
// ring and mirror are walks over such columns.
//
// Why it is built so
//  1. The work is arithmetic: 360 particles are 11.5 kB and stay in L1. So each bond is computed
//     once (Newton's third law), not twice as in the listing, and nothing is gathered.
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
//     L1; `sums` takes differences again, forces, sums, kick, drift and wall. What limits a sweep
//     is not the ports but how far the processor looks ahead: a column hangs together over some 45
//     cycles (load, difference, square, product, division, products; then the force and five sums
//     one after the other), and its results fill half of the register file. Two short sweeps keep
//     two or three columns in flight, one long one hardly more than one. One sweep of 208
//     instructions took 98 cycles a column on Zen 3, two of 74 and 146 take 60.
//  4. The differences are taken again rather than kept: two loads and a subtraction, on ports that
//     are free, for a store and two loads. Keeping them took 70 cycles.
//  5. The reciprocals of up to four squared distances share one division (multiply, divide once,
//     multiply back): IEEE operations only, so every machine gives the same bits.
//  6. Nothing is called within a sweep. How near the nearest particle came to a wall is one
//     minimum a particle; where one is behind, the columns are mirrored after the sweep. A call in
//     the loop, never taken, still made the compiler keep everything in memory around it.
//  7. One answer: a particle's left bonds are summed from the gravity kick on their own, the others
//     from its velocity, and the two are added once. That association, and the grouping of
//     the reciprocals (the bonds of one column), depend on the neighbourhood alone, never on where
//     a lane, a tile or a thread begins.
//
// Operations per column and vector, R = 3 rings, 7 bonds, law (3, 5):
//   a bond: 2 for R^2, 3 for F/R, 4 for the sums; 2 + 2 subtractions    63 mul/fma, 28 sub
//   the reciprocals: 9 + 6 multiplications, 2 divisions                 15 mul,      2 div
//   a particle: 1 addition and 1 fma each for x and y; 1 minimum         6 fma,      6 add, 3 min
// 84 multiplications: on two ports 42 cycles, 30 columns of vectors with 4 lanes, 15 with 8. (Where
// additions share these ports, as on Intel's, 60 cycles.)
// Reached on Zen 3: 60 cycles, 70 %, in the minutes in which the machine was quiet; 78 to 85 in
// others (one sweep: 107 to 117), probably beside a neighbour on the core's other thread, which
// takes half of how far it looks ahead. 220 instructions, 79 of them loads.
// On Zen 4, which takes one multiplication of 8 lanes a cycle: 84 cycles with 8 lanes, of which 70
// to 85 % were reached (README, by the minute).
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

#include "kernels/stepping/ring_shape.hpp"
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
  return hn::Set(hn::DFromV<V>(), hn::TFromV<V>{1});
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

/// D: Highway's tag with the numbers and lanes to use. Law: the form the scene needs. R: rings.
/// low: positions and velocities have low parts (ring_precision-inl.hpp). The form of the walls is
/// a parameter of the sweeps: all forms move the same columns.
template <class D, class Law, int R, bool low = false>
class RingColumns {
 public:
  using Tag = D;
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  static constexpr bool has_low = low;
  static constexpr D d{};
  static constexpr size_t L = hn::MaxLanes(D());
  static constexpr int rings = R;
  static constexpr size_t row = size_t{R} * L;      // numbers of x of a column
  static constexpr size_t positions = 2 * row;      // numbers of x and y
  static constexpr size_t low_positions = 4 * row;  // behind x, y, vx and vy
  static constexpr size_t low_velocities = 6 * row;
  static constexpr size_t block = (low ? 8 : 4) * row;
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

  /// What becomes of the sums of a column from its velocity on.
  enum class Rest {
    finish,  ///< its left sums are there: kick, drift, wall
    keep,    ///< they come later: put into the place of the velocities
    drop     ///< another tile's column, only its right neighbour's left sums are wanted
  };

  RingColumns(RingShape shape, PairLaw law) : shape_(std::move(shape)), law_(law) {}

  /// Each lane's constants; a lane without any (null) stands still.
  [[nodiscard]] Constants make_constants(const StageConstants* const* lanes) const {
    const auto each = [lanes](const auto& value_of) HWY_ATTR {
      HWY_ALIGN T values[L];
      for (size_t l = 0; l < L; ++l) {
        values[l] = lanes[l] == nullptr ? T{0} : static_cast<T>(value_of(*lanes[l]));
      }
      return hn::Load(d, values);
    };
    Constants c;
    for (int bond = 0; bond < bonds_a_column; ++bond) {
      const auto at = static_cast<size_t>(bond_class(bond));
      c.attraction[bond] = each([at](const StageConstants& s) { return s.kick[at].attraction; });
      c.repulsion[bond] = each([at](const StageConstants& s) { return s.kick[at].repulsion; });
    }
    c.gx = each([](const StageConstants& s) { return s.gravity.x; });
    c.gy = each([](const StageConstants& s) { return s.gravity.y; });
    c.drift = each([](const StageConstants& s) { return s.drift; });
    return c;
  }
  /// The same in all lanes.
  [[nodiscard]] Constants make_constants(const StageConstants& stage) const {
    const StageConstants* lanes[L];
    std::fill_n(lanes, L, &stage);
    return make_constants(lanes);
  }

  /// The class of bond b of a column.
  [[nodiscard]] int bond_class(int b) const {
    if (b < R) return shape_.along[static_cast<size_t>(b)];
    const auto inner = static_cast<size_t>((b - R) / 2);
    return (b - R) % 2 == 0 ? shape_.same[inner] : shape_.diagonal[inner];
  }

  /// x and y of ring r of the column at `at`.
  static HWY_INLINE V x_of(const T* at, int r) {
    return hn::Load(d, at + static_cast<size_t>(r) * L);
  }
  static HWY_INLINE V y_of(const T* at, int r) {
    return hn::Load(d, at + row + static_cast<size_t>(r) * L);
  }

  static HWY_INLINE Column load(const T* at) {
    Column column;
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
      column.x[r] = x_of(at, r);
      column.y[r] = y_of(at, r);
    }
    return column;
  }
  static HWY_INLINE void store(const Column& column, T* at) {
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) {
      hn::Store(column.x[r], d, at + static_cast<size_t>(r) * L);
      hn::Store(column.y[r], d, at + row + static_cast<size_t>(r) * L);
    }
  }

  /// Lane l gets lane l + shift's value: +1 turns column 0 into column K, -1 the other way round.
  static HWY_INLINE Column turn(const Column& column, int shift) {
    if constexpr (L == 1) {
      return column;
    } else {
      HWY_ALIGN hwy::MakeSigned<T> lanes[L];
      for (size_t l = 0; l < L; ++l) {
        lanes[l] = static_cast<hwy::MakeSigned<T>>((l + L + static_cast<size_t>(shift)) % L);
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
  static HWY_INLINE void reciprocals(const T* at, size_t columns, T* u) {
    Column here = load(at);
    for (; columns > 0; --columns, u += terms) {
      at += block;
      const Column next = load(at);
      group_reciprocals<0>(here, next, at - block, u);
      here = next;
    }
  }

  /// Second sweep, over the same columns. `left` comes with the left sums of the first column and
  /// goes with those of the column behind the last. `nearest` becomes the least distance from a
  /// wall, NaN apart.
  template <Rest rest, class Walls>
  HWY_INLINE void sums(const Constants& c, const Walls& walls, T* at, size_t columns, const T* u,
                       Column& left, V& nearest) const {
    for (; columns > 0; --columns, at += block, u += terms) {
      Column from_velocity, on_next;
      ring_sums<0, rest>(c, walls, at, u, from_velocity, left, on_next, nearest);
      left = on_next;
    }
  }

  /// Kick, drift and wall of a column whose sums from the velocity on were kept.
  template <class Walls>
  HWY_INLINE void finish_kept(const Constants& c, const Walls& walls, T* at, const Column& left,
                              V& nearest) const {
    const Column kept = load(at + summed);
    BOUNCE_UNROLL for (int r = 0; r < R; ++r) finish(c, walls, at, r, kept, left, nearest);
  }

  /// `nearest` before the first column.
  static HWY_INLINE V far_away() { return hn::Set(d, hwy::HighestValue<T>()); }

  /// After the sweeps: mirrors what stands behind a wall.
  template <class Walls>
  static HWY_INLINE void mirror_at_walls(const Constants& c, const Walls& walls, T* at,
                                         size_t columns, V nearest) {
    if constexpr (Walls::any) {
      if (HWY_UNLIKELY(!hn::AllTrue(d, hn::Gt(nearest, walls.threshold(d))))) {
        mirror_columns(c, walls, at, columns);
      }
    }
  }

 private:
  // Where what a particle's sums begin from stands.
  static constexpr size_t summed = low ? low_velocities : positions;

  // Numbers of the bonds of a column.
  static constexpr int along(int ring) { return ring; }
  static constexpr int same(int inner) { return R + 2 * inner; }
  static constexpr int diagonal(int inner) { return R + 2 * inner + 1; }

  // Bonds first, first + 1, ... of a column share a division, most_in_group of them.
  template <int first>
  static HWY_INLINE void group_reciprocals(const Column& here, const Column& next, const T* at,
                                           T* u) {
    constexpr int count = std::min(most_in_group, bonds_a_column - first);
    V r2[count], over[count];
    BOUNCE_UNROLL for (int i = 0; i < count; ++i) {
      const BondPlace p = place(first + i);
      const Column& other = p.next ? next : here;
      V dx = hn::Sub(here.x[p.from], other.x[p.to]);
      V dy = hn::Sub(here.y[p.from], other.y[p.to]);
      if constexpr (low) {
        const T *from = at + low_positions, *to = p.next ? from + block : from;
        dx = hn::Add(dx, hn::Sub(x_of(from, p.from), x_of(to, p.to)));
        dy = hn::Add(dy, hn::Sub(y_of(from, p.from), y_of(to, p.to)));
      }
      r2[i] = hn::MulAdd(dy, dy, hn::Mul(dx, dx));
    }
    reciprocals_of<count>(r2, over);
    BOUNCE_UNROLL for (int i = 0; i < count; ++i) {
      hn::Store(over[i], d, u + static_cast<size_t>(first + i) * L);
    }
    if constexpr (first + count < bonds_a_column) {
      group_reciprocals<first + count>(here, next, at, u);
    }
  }

  // Bond b: on `rest` what acts on the column at `at`, on `on_next` what acts on the next one.
  template <int b>
  HWY_INLINE void bond(const Constants& c, const T* at, const T* u, Column& rest,
                       Column& on_next) const {
    constexpr BondPlace p = place(b);
    const T* to = p.next ? at + block : at;
    const V dx = hn::Sub(x_of(at, p.from), x_of(to, p.to));
    const V dy = hn::Sub(y_of(at, p.from), y_of(to, p.to));
    const V over = hn::Load(d, u + static_cast<size_t>(b) * L);
    const V f = law_.force_over_distance(d, over, c.attraction[b], c.repulsion[b]);
    rest.x[p.from] = hn::MulAdd(f, dx, rest.x[p.from]);
    rest.y[p.from] = hn::MulAdd(f, dy, rest.y[p.from]);
    // The bond along a ring is the first from the left: it starts that sum, from the gravity kick.
    Column& on = p.next ? on_next : rest;
    on.x[p.to] = hn::NegMulAdd(f, dx, b < R ? c.gx : on.x[p.to]);
    on.y[p.to] = hn::NegMulAdd(f, dy, b < R ? c.gy : on.y[p.to]);
  }

  template <int r>
  HWY_INLINE void start_ring(const Constants& c, const T* at, const T* u, Column& rest,
                             Column& on_next) const {
    rest.x[r] = x_of(at + summed, r);
    rest.y[r] = y_of(at + summed, r);
    bond<along(r)>(c, at, u, rest, on_next);
  }

  template <Rest rest, class Walls>
  HWY_INLINE void end_ring(const Constants& c, const Walls& walls, T* at, int r, const Column& sums,
                           const Column& left, V& nearest) const {
    if constexpr (rest == Rest::finish) {
      finish(c, walls, at, r, sums, left, nearest);
    } else if constexpr (rest == Rest::keep) {
      hn::Store(sums.x[r], d, at + summed + static_cast<size_t>(r) * L);
      hn::Store(sums.y[r], d, at + summed + row + static_cast<size_t>(r) * L);
    }
  }

  // The bonds from ring to ring outwards: a ring is finished when its last bond is summed, so few
  // sums are alive at a time. Along, same, diagonal of each pair of rings: the order of the numbers
  // for each particle.
  template <int ring, Rest rest, class Walls>
  HWY_INLINE void ring_sums(const Constants& c, const Walls& walls, T* at, const T* u, Column& sums,
                            const Column& left, Column& on_next, V& nearest) const {
    if constexpr (ring == 0) start_ring<0>(c, at, u, sums, on_next);
    if constexpr (ring + 1 < R) {
      start_ring<ring + 1>(c, at, u, sums, on_next);
      bond<same(ring)>(c, at, u, sums, on_next);
      bond<diagonal(ring)>(c, at, u, sums, on_next);
    }
    end_ring<rest>(c, walls, at, ring, sums, left, nearest);
    if constexpr (ring + 1 < R) {
      ring_sums<ring + 1, rest>(c, walls, at, u, sums, left, on_next, nearest);
    }
  }

  template <class Walls>
  HWY_INLINE void finish(const Constants& c, const Walls& walls, T* at, int ring,
                         const Column& sums, const Column& left, V& nearest) const {
    T* const in_ring = at + static_cast<size_t>(ring) * L;
    const V x = move(c.drift, hn::Add(sums.x[ring], left.x[ring]), in_ring);
    const V y = move(c.drift, hn::Add(sums.y[ring], left.y[ring]), in_ring + row);
    if constexpr (Walls::any) nearest = hn::Min(walls.distance(d, x, y), nearest);
  }

  // One coordinate of a particle: `at` its place, `sum` its velocity, or the kick where that has a
  // low part. Returns the coordinate.
  static HWY_INLINE V move(V drift, V sum, T* at) {
    V v = sum, x = hn::Load(d, at);
    if constexpr (low) {
      v = add(hn::Load(d, at + positions), sum, at + low_velocities);
      const V low_v = hn::Load(d, at + low_velocities), low_x = hn::Load(d, at + low_positions);
      x = add(x, hn::MulAdd(drift, v, hn::MulAdd(drift, low_v, low_x)), at + low_positions);
    } else {
      x = hn::MulAdd(drift, v, x);
    }
    hn::Store(v, d, at + positions);
    hn::Store(x, d, at);
    return x;
  }

  // high + more; what is lost in it goes to `lost`. That is exact where |more| <= |high|; else it
  // is off by an ULP of `more`, as `more` itself is.
  static HWY_INLINE V add(V high, V more, T* lost) {
    const V sum = hn::Add(high, more);
    hn::Store(hn::Sub(more, hn::Sub(sum, high)), d, lost);
    return sum;
  }

  template <class Walls>
  static HWY_NOINLINE void mirror_columns(const Constants& c, const Walls& walls, T* at,
                                          size_t columns) {
    for (; columns > 0; --columns, at += block) {
      for (int r = 0; r < R; ++r) {
        if (hn::AllTrue(d, walls.clear(d, x_of(at, r), y_of(at, r)))) continue;
        T* x = at + static_cast<size_t>(r) * L;
        if constexpr (low) {
          mirror_with_low(c.drift, walls.walls, x);
        } else {
          walls.mirror(d, c.drift, x, x + row, x + 2 * row, x + 3 * row);
        }
      }
    }
  }

  // The rules are linear in position and velocity: a low part is turned by the wall as the high
  // one. Where a particle is stopped, nothing is left of it.
  static HWY_NOINLINE void mirror_with_low(V drift, const std::vector<Wall>& walls, T* x) {
    const V zero = hn::Zero(d);
    for (const Wall& wall : walls) {
      const auto w = in_all_lanes(d, wall);
      const V distance = distance_from(w, hn::Load(d, x), hn::Load(d, x + row));
      reflect(d, w, drift, x, x + row, x + 2 * row, x + 3 * row);
      const auto met = hn::And(hn::Le(distance, zero), hn::Ge(drift, zero));
      const V back = wall.contact == Contact::resolved ? w.beta : hn::Set(d, T{-1});
      turn_low(met, w, one_of<V>(), back, x + low_positions);
      T* const slow = x + low_velocities;
      turn_low(met, w, w.alpha, w.beta, slow);
      for (const size_t part : {size_t{0}, row}) {
        const auto stopped = hn::And(met, hn::Eq(hn::Load(d, x + positions + part), zero));
        hn::Store(hn::IfThenElse(stopped, zero, hn::Load(d, slow + part)), d, slow + part);
      }
    }
  }

  // In the lanes of `met`: the part along the wall times `along`, the part across it times `back`.
  template <class Mask>
  static HWY_INLINE void turn_low(Mask met, const WallVectors<V>& w, V along, V back, T* at) {
    const V lx = hn::Load(d, at), ly = hn::Load(d, at + row);
    const V across = hn::MulAdd(w.nx, lx, hn::Mul(w.ny, ly));
    const V tx = hn::NegMulAdd(across, w.nx, lx), ty = hn::NegMulAdd(across, w.ny, ly);
    const V after = hn::Mul(back, across);
    const V new_x = hn::MulAdd(along, tx, hn::Mul(after, w.nx));
    const V new_y = hn::MulAdd(along, ty, hn::Mul(after, w.ny));
    hn::Store(hn::IfThenElse(met, new_x, lx), d, at);
    hn::Store(hn::IfThenElse(met, new_y, ly), d, at + row);
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
