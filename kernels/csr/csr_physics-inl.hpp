// csr: the general fast kernel. Any neighbour list, any law, any walls, any threads.
//
// Why it is built so (sliced_stepper-inl.hpp says how particles, slices and threads are laid out)
//  1. A particle's sum starts from the gravity kick and takes its neighbours in the order of its
//     row; two neighbours (0 and 1, 2 and 3, ...) share one division. Both depend on the row alone,
//     so vector width and threads do not change a bit.
//  2. A lane without a neighbour that others have takes part with R^2 = 1 and constants 0, which
//     adds a zero. The 0.0 added to the new velocity makes every zero a positive one, so that such
//     a zero cannot show in the bits either.
//  3. Nothing is called among the slices but for ragged ones: walls are looked at after a chunk of
//     them. A call in the loop, hardly ever taken, made the compiler keep everything in memory
//     around it; without one a step takes 0.8 of the time (seen on an AMD EPYC).
//
// Operations an entry, law (3, 5): 2 loads, 2 subtractions, 2 for R^2, 1.5 multiplications and half
// a division for the reciprocal, 3 for F/R, 2 fma for the sums; 1680 entries a step for the paper's
// ball (both directions) against 840 bonds in the ring kernel.
//
// Not taken: writing -f to the neighbour (half the arithmetic, but scattered stores that collide
// between lanes and threads, and sums whose order depends on them).
#if defined(BOUNCE_CSR_PHYSICS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_CSR_PHYSICS_INL_HPP
#undef BOUNCE_CSR_PHYSICS_INL_HPP
#else
#define BOUNCE_CSR_PHYSICS_INL_HPP
#endif

#include <hwy/highway.h>

#include "kernels/csr/sliced_stepper-inl.hpp"
#include "kernels/stepping/vector_law-inl.hpp"
#include "kernels/stepping/vector_walls-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// Tag: Highway's tag with the lanes to use. Law: the form the scene needs.
template <class Tag, class Law>
class FastPhysics {
 public:
  using D = Tag;

  explicit FastPhysics(const Model& model) : law_(model.law), walls_(&model.walls) {}
  // Constants come multiplied by the kick.
  static constexpr bool scaled() { return true; }

  HWY_INLINE void slice(const CombinationTable& table, const SlicedBonds& bonds, const Slice& slice,
                        size_t at, const double* x, const double* y, ParticleStore& store,
                        double* new_x, double* new_y) const {
    if (HWY_LIKELY(slice.full == slice.all && slice.all % 2 == 0)) {
      const V px = hn::Load(d, x + at), py = hn::Load(d, y + at);
      V kx = hn::Set(d, table.gx), ky = hn::Set(d, table.gy);
      add_pairs(table, bonds, slice, x, y, px, py, kx, ky);
      move(table, at, px, py, kx, ky, store, new_x, new_y);
    } else {
      ragged_slice(table, bonds, slice, at, x, y, store, new_x, new_y);
    }
  }

  /// Mirrors what stands behind a wall of the `vectors` vectors from `at` on, just moved.
  HWY_INLINE void mirror_at_walls(const CombinationTable& table, size_t at, size_t vectors,
                                  ParticleStore& store, double* new_x, double* new_y) const {
    const auto place = [=](size_t k) { return Place{new_x + at + k * L, new_y + at + k * L}; };
    if (HWY_LIKELY(all_in_front(d, *walls_, vectors, place))) return;
    mirror_vectors(table, at, vectors, store, new_x, new_y);
  }

 private:
  using V = hn::Vec<D>;
  static constexpr D d{};
  static constexpr size_t L = hn::MaxLanes(D());

  struct Bond {
    V dx, dy, r2;
    HWY_INLINE Bond(const SlicedBonds& bonds, const SliceEntry& entry, const double* x,
                    const double* y, V px, V py) {
      V nx, ny;
      load_neighbours(d, bonds, entry, x, y, nx, ny);
      dx = hn::Sub(px, nx);
      dy = hn::Sub(py, ny);
      r2 = hn::MulAdd(dy, dy, hn::Mul(dx, dx));
    }
  };

  HWY_INLINE void add(const CombinationTable& table, const SliceEntry& entry, const Bond& bond, V u,
                      V& kx, V& ky) const {
    const auto row = static_cast<size_t>(entry.combination) * hn::Lanes(d);
    const V f = law_.force_over_distance(d, u, hn::Load(d, table.attraction.data() + row),
                                         hn::Load(d, table.repulsion.data() + row));
    kx = hn::MulAdd(f, bond.dx, kx);
    ky = hn::MulAdd(f, bond.dy, ky);
  }

  // The entries that every lane has, two by two. Returns how many those are.
  HWY_INLINE std::int32_t add_pairs(const CombinationTable& table, const SlicedBonds& bonds,
                                    const Slice& slice, const double* x, const double* y, V px,
                                    V py, V& kx, V& ky) const {
    const SliceEntry* entry = bonds.entries.data() + slice.begin;
    std::int32_t k = 0;
    for (; k + 1 < slice.full; k += 2) {
      const Bond a(bonds, entry[k], x, y, px, py), b(bonds, entry[k + 1], x, y, px, py);
      const V over_both = hn::Div(hn::Set(d, 1.0), hn::Mul(a.r2, b.r2));
      add(table, entry[k], a, hn::Mul(over_both, b.r2), kx, ky);
      add(table, entry[k + 1], b, hn::Mul(over_both, a.r2), kx, ky);
    }
    return k;
  }

  // Kick and drift.
  HWY_INLINE void move(const CombinationTable& table, size_t at, V px, V py, V kx, V ky,
                       ParticleStore& store, double* new_x, double* new_y) const {
    const V zero = hn::Zero(d), drift = hn::Set(d, table.drift);
    const V vx = hn::Add(hn::Add(hn::Load(d, store.vx.data() + at), kx), zero);
    const V vy = hn::Add(hn::Add(hn::Load(d, store.vy.data() + at), ky), zero);
    hn::Store(vx, d, store.vx.data() + at);
    hn::Store(vy, d, store.vy.data() + at);
    hn::Store(hn::MulAdd(drift, vx, px), d, new_x + at);
    hn::Store(hn::MulAdd(drift, vy, py), d, new_y + at);
  }

  // A slice some of whose entries lack in some lanes, or that has an odd number of them.
  HWY_NOINLINE void ragged_slice(const CombinationTable& table, const SlicedBonds& bonds,
                                 const Slice& slice, size_t at, const double* x, const double* y,
                                 ParticleStore& store, double* new_x, double* new_y) const {
    const V px = hn::Load(d, x + at), py = hn::Load(d, y + at);
    V kx = hn::Set(d, table.gx), ky = hn::Set(d, table.gy);
    std::int32_t k = add_pairs(table, bonds, slice, x, y, px, py, kx, ky);
    for (; k < slice.all; k += 2) add_ragged(table, bonds, slice, k, x, y, px, py, kx, ky);
    move(table, at, px, py, kx, ky, store, new_x, new_y);
  }

  HWY_NOINLINE void mirror_vectors(const CombinationTable& table, size_t at, size_t vectors,
                                   ParticleStore& store, double* new_x, double* new_y) const {
    const V drift = hn::Set(d, table.drift);
    for (size_t i = at; i < at + vectors * L; i += L) {
      meet_walls(d, *walls_, drift, new_x + i, new_y + i, store.vx.data() + i, store.vy.data() + i);
    }
  }

  // Entries k and k + 1 where lanes, or all of them, lack one.
  HWY_NOINLINE void add_ragged(const CombinationTable& table, const SlicedBonds& bonds,
                               const Slice& slice, std::int32_t k, const double* x, const double* y,
                               V px, V py, V& kx, V& ky) const {
    const SliceEntry* entry = bonds.entries.data() + slice.begin;
    const V one = hn::Set(d, 1.0);
    Bond a(bonds, entry[k], x, y, px, py);
    a.r2 = hn::IfThenElse(present(table, entry[k]), a.r2, one);
    if (k + 1 == slice.all) {
      add(table, entry[k], a, hn::Div(one, a.r2), kx, ky);
      return;
    }
    Bond b(bonds, entry[k + 1], x, y, px, py);
    b.r2 = hn::IfThenElse(present(table, entry[k + 1]), b.r2, one);
    const V over_both = hn::Div(one, hn::Mul(a.r2, b.r2));
    add(table, entry[k], a, hn::Mul(over_both, b.r2), kx, ky);
    add(table, entry[k + 1], b, hn::Mul(over_both, a.r2), kx, ky);
  }

  static HWY_INLINE hn::Mask<D> present(const CombinationTable& table, const SliceEntry& entry) {
    const auto row = static_cast<size_t>(entry.combination) * hn::Lanes(d);
    return hn::Gt(hn::Load(d, table.present.data() + row), hn::Zero(d));
  }

  Law law_;
  const std::vector<Wall>* walls_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
