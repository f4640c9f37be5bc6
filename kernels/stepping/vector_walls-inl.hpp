// The wall rule on vectors (paper, section 3): a particle with not (n.x > offset) is mirrored, its
// tangential velocity multiplied by alpha, its normal velocity by beta. Not-a-number is not
// mirrored.
//
// A step tests, unless a bound says that nothing can be found (free_flight.hpp); only a vector with
// a particle behind a wall is mirrored, out of line. So alpha and beta cost nothing while nothing
// touches, and no instantiation depends on them.
#if defined(BOUNCE_VECTOR_WALLS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_VECTOR_WALLS_INL_HPP
#undef BOUNCE_VECTOR_WALLS_INL_HPP
#else
#define BOUNCE_VECTOR_WALLS_INL_HPP
#endif

#include <hwy/highway.h>

#include <vector>

#include "kernels/model/scene.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A wall, in vectors: the same one in all lanes, or each lane its own.
template <class V>
struct alignas(64) WallVectors {
  V nx, ny, offset, alpha, beta;
};

template <class D>
HWY_INLINE WallVectors<hn::Vec<D>> in_all_lanes(D d, const Wall& wall) {
  return {hn::Set(d, wall.normal.x), hn::Set(d, wall.normal.y), hn::Set(d, wall.offset),
          hn::Set(d, wall.alpha), hn::Set(d, wall.beta)};
}

/// The distance of points from a wall, cm.
template <class V>
HWY_INLINE V distance_from(const WallVectors<V>& wall, V x, V y) {
  return hn::MulAdd(wall.nx, x, hn::MulSub(wall.ny, y, wall.offset));
}

/// Mirrors `vectors` vectors of particles at one wall.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE void reflect(D d, const WallVectors<V>& wall, double* x, double* y, double* vx,
                          double* vy, size_t vectors) {
  for (size_t at = 0; at < vectors * hn::MaxLanes(D()); at += hn::MaxLanes(D())) {
    const V px = hn::Load(d, x + at), py = hn::Load(d, y + at);
    const V ux = hn::Load(d, vx + at), uy = hn::Load(d, vy + at);
    const V distance = distance_from(wall, px, py);
    // Not-a-number stays where it is, whatever stands beside it in the vector.
    const auto clear = hn::Not(hn::Le(distance, hn::Zero(d)));
    const V twice = hn::Add(distance, distance);
    const V normal_speed = hn::MulAdd(wall.nx, ux, hn::Mul(wall.ny, uy));
    const V tx = hn::NegMulAdd(normal_speed, wall.nx, ux);
    const V ty = hn::NegMulAdd(normal_speed, wall.ny, uy);
    const V after = hn::Mul(wall.beta, normal_speed);
    const V mirrored_x = hn::NegMulAdd(twice, wall.nx, px);
    const V mirrored_y = hn::NegMulAdd(twice, wall.ny, py);
    const V mirrored_vx = hn::MulAdd(wall.alpha, tx, hn::Mul(after, wall.nx));
    const V mirrored_vy = hn::MulAdd(wall.alpha, ty, hn::Mul(after, wall.ny));
    hn::Store(hn::IfThenElse(clear, px, mirrored_x), d, x + at);
    hn::Store(hn::IfThenElse(clear, py, mirrored_y), d, y + at);
    hn::Store(hn::IfThenElse(clear, ux, mirrored_vx), d, vx + at);
    hn::Store(hn::IfThenElse(clear, uy, mirrored_vy), d, vy + at);
  }
}

/// The same at all walls, one wall after another.
template <class D>
HWY_INLINE void reflect(D d, const std::vector<Wall>& walls, double* x, double* y, double* vx,
                        double* vy, size_t vectors) {
  for (const Wall& wall : walls) reflect(d, in_all_lanes(d, wall), x, y, vx, vy, vectors);
}

/// No wall in the scene: no test.
struct NoWalls {
  static constexpr bool any = false;
  explicit NoWalls(const std::vector<Wall>&) {}
};

/// One wall with normal (0, 1): one comparison a vector.
struct Floor {
  static constexpr bool any = true;
  explicit Floor(const std::vector<Wall>& all) : walls(all) {}
  template <class D, class V>
  HWY_INLINE hn::Mask<D> clear(D d, V, V y) const {
    return hn::Gt(y, threshold(d));
  }
  /// No nearer than threshold() is a particle that must be mirrored.
  template <class D, class V>
  HWY_INLINE V distance(D, V, V y) const {
    return y;
  }
  template <class D>
  HWY_INLINE hn::Vec<D> threshold(D d) const {
    return hn::Set(d, walls[0].offset);
  }
  template <class D>
  void mirror(D d, double* x, double* y, double* vx, double* vy) const {
    reflect(d, walls, x, y, vx, vy, 1);
  }
  const std::vector<Wall>& walls;
};

/// Any number of walls in any direction.
struct AnyWalls {
  static constexpr bool any = true;
  explicit AnyWalls(const std::vector<Wall>& all) : walls(all) {}
  template <class D, class V>
  HWY_INLINE hn::Mask<D> clear(D d, V x, V y) const {
    return hn::Gt(distance(d, x, y), threshold(d));
  }
  template <class D, class V>
  HWY_INLINE V distance(D d, V x, V y) const {
    V nearest = distance_from(in_all_lanes(d, walls[0]), x, y);
    for (size_t w = 1; w < walls.size(); ++w) {
      nearest = hn::Min(distance_from(in_all_lanes(d, walls[w]), x, y), nearest);
    }
    return nearest;
  }
  template <class D>
  HWY_INLINE hn::Vec<D> threshold(D d) const {
    return hn::Zero(d);
  }
  template <class D>
  void mirror(D d, double* x, double* y, double* vx, double* vy) const {
    reflect(d, walls, x, y, vx, vy, 1);
  }
  const std::vector<Wall>& walls;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
