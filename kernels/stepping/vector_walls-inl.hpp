// The wall rule on vectors (paper, section 3): a particle with not (n.x > offset) is mirrored, its
// tangential velocity multiplied by alpha, its normal velocity by beta. Not-a-number is not
// mirrored.
//
// A step tests; only a vector with a particle behind a wall is mirrored, out of line. So alpha and
// beta cost nothing while nothing touches, and no instantiation depends on them.
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

/// The distance of points from a wall, cm.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V distance_from(D d, const Wall& wall, V x, V y) {
  const V along_y = hn::MulSub(hn::Set(d, wall.normal.y), y, hn::Set(d, wall.offset));
  return hn::MulAdd(hn::Set(d, wall.normal.x), x, along_y);
}

/// Mirrors `vectors` vectors of particles at all walls, one wall after another.
template <class D>
HWY_NOINLINE void reflect(D d, const std::vector<Wall>& walls, double* x, double* y, double* vx,
                          double* vy, size_t vectors) {
  using V = hn::Vec<D>;
  for (size_t i = 0; i < vectors; ++i) {
    const size_t at = i * hn::Lanes(d);
    V px = hn::Load(d, x + at), py = hn::Load(d, y + at);
    V ux = hn::Load(d, vx + at), uy = hn::Load(d, vy + at);
    for (const Wall& wall : walls) {
      const V nx = hn::Set(d, wall.normal.x), ny = hn::Set(d, wall.normal.y);
      const V distance = distance_from(d, wall, px, py);
      // Not-a-number stays where it is, whatever stands beside it in the vector.
      const auto clear = hn::Not(hn::Le(distance, hn::Zero(d)));
      const V twice = hn::Add(distance, distance);
      const V normal_speed = hn::MulAdd(nx, ux, hn::Mul(ny, uy));
      const V tx = hn::NegMulAdd(normal_speed, nx, ux), ty = hn::NegMulAdd(normal_speed, ny, uy);
      const V alpha = hn::Set(d, wall.alpha);
      const V after = hn::Mul(hn::Set(d, wall.beta), normal_speed);
      px = hn::IfThenElse(clear, px, hn::NegMulAdd(twice, nx, px));
      py = hn::IfThenElse(clear, py, hn::NegMulAdd(twice, ny, py));
      ux = hn::IfThenElse(clear, ux, hn::MulAdd(alpha, tx, hn::Mul(after, nx)));
      uy = hn::IfThenElse(clear, uy, hn::MulAdd(alpha, ty, hn::Mul(after, ny)));
    }
    hn::Store(px, d, x + at);
    hn::Store(py, d, y + at);
    hn::Store(ux, d, vx + at);
    hn::Store(uy, d, vy + at);
  }
}

/// No wall in the scene: no test.
struct NoWalls {
  static constexpr bool any = false;
  explicit NoWalls(const std::vector<Wall>& none) : walls(none) {}
  const std::vector<Wall>& walls;
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
    V nearest = distance_from(d, walls[0], x, y);
    for (size_t w = 1; w < walls.size(); ++w) {
      nearest = hn::Min(distance_from(d, walls[w], x, y), nearest);
    }
    return nearest;
  }
  template <class D>
  HWY_INLINE hn::Vec<D> threshold(D d) const {
    return hn::Zero(d);
  }
  const std::vector<Wall>& walls;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
