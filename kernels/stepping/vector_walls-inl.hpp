// The wall rules on vectors (wall_rule.hpp): a particle with not (n.x > offset) is mirrored, its
// tangential velocity multiplied by alpha, its normal velocity by beta; or, where the contact is
// resolved, given back the part of the drift that it spent behind the wall. Not-a-number is not
// mirrored.
//
// A step tests, unless a bound says that nothing can be found (free_flight.hpp); only a vector with
// a particle behind a wall is mirrored, out of line. So alpha, beta and the rule cost nothing while
// nothing touches, and no instantiation depends on them. The resolved rule knows where a particle
// rests by its state alone: on the wall, without velocity. It needs no memory of contacts, so a
// state is still positions and velocities, and restarts as such.
#if defined(BOUNCE_VECTOR_WALLS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_VECTOR_WALLS_INL_HPP
#undef BOUNCE_VECTOR_WALLS_INL_HPP
#else
#define BOUNCE_VECTOR_WALLS_INL_HPP
#endif

#include <hwy/highway.h>

#include <vector>

#include "kernels/model/wall_rule.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A wall, in vectors: the same one in all lanes, or each lane its own. resolved: 1 or 0.
template <class V>
struct alignas(64) WallVectors {
  V nx, ny, offset, alpha, beta, resolved;
};

template <class D>
HWY_INLINE WallVectors<hn::Vec<D>> in_all_lanes(D d, const Wall& wall) {
  const auto all = [d](double value)
                       HWY_ATTR { return hn::Set(d, static_cast<hn::TFromD<D>>(value)); };
  return {all(wall.normal.x), all(wall.normal.y),
          all(wall.offset),   all(wall.alpha),
          all(wall.beta),     all(wall.contact == Contact::resolved ? 1.0 : 0.0)};
}

/// The distance of points from a wall, cm.
template <class V>
HWY_INLINE V distance_from(const WallVectors<V>& wall, V x, V y) {
  return hn::MulAdd(wall.nx, x, hn::MulSub(wall.ny, y, wall.offset));
}

/// What the rules differ in: how far a particle is lifted along the normal, how much of its
/// tangential velocity it keeps, and for how long that velocity is given back.
template <class V>
struct WallAnswer {
  V lift, alpha, back;
};

/// Of the paper's rule.
template <class V>
HWY_INLINE WallAnswer<V> mirror_answer(const WallVectors<V>& wall, V distance) {
  return {hn::Add(distance, distance), wall.alpha, hn::Zero(hn::DFromV<V>())};
}

/// Of the resolved rule. moved: along the normal in the drift. size: of the coordinates.
template <class V>
HWY_INLINE WallAnswer<V> resolved_answer(const WallVectors<V>& wall, V distance, V moved, V drift,
                                         V size) {
  using T = hn::TFromV<V>;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, T{1});
  const V slack = hn::Mul(hn::Set(d, T{resting_slack}), hn::Add(size, hn::Abs(wall.offset)));
  const auto resting = hn::And(hn::And(hn::Eq(wall.beta, zero), hn::Lt(wall.alpha, one)),
                               hn::Le(hn::Sub(distance, moved), slack));
  const V alpha = hn::IfThenElse(resting, zero, wall.alpha);
  const V part = hn::Div(distance, moved);
  // Not above 0, or not a number, where the drift did not lead into the wall.
  const V behind =
      hn::IfThenElse(hn::Gt(part, zero), hn::Min(part, hn::Set(d, T{most_part_behind})), zero);
  return {hn::Mul(hn::Sub(one, wall.beta), distance), alpha,
          hn::Mul(hn::Mul(behind, drift), hn::Sub(alpha, one))};
}

/// What a vector of particles at (x, y) does at one wall, after a drift of `drift` (s).
template <class D, class V = hn::Vec<D>, class T = hn::TFromD<D>>
HWY_NOINLINE void reflect(D d, const WallVectors<V>& wall, V drift, T* x, T* y, T* vx, T* vy) {
  const V px = hn::Load(d, x), py = hn::Load(d, y);
  const V ux = hn::Load(d, vx), uy = hn::Load(d, vy);
  const V distance = distance_from(wall, px, py);
  // Not-a-number stays where it is, whatever stands beside it in the vector; a stage that steps
  // back meets no wall.
  const V zero = hn::Zero(d);
  const auto clear = hn::Or(hn::Not(hn::Le(distance, zero)), hn::Lt(drift, zero));
  const V normal_speed = hn::MulAdd(wall.nx, ux, hn::Mul(wall.ny, uy));
  const V tx = hn::NegMulAdd(normal_speed, wall.nx, ux);
  const V ty = hn::NegMulAdd(normal_speed, wall.ny, uy);
  WallAnswer<V> answer = mirror_answer(wall, distance);
  V rest_x = px, rest_y = py;
  const auto resolved = hn::Gt(wall.resolved, zero);
  if (!hn::AllFalse(d, resolved)) {
    const V moved = hn::Mul(drift, normal_speed), size = hn::Add(hn::Abs(px), hn::Abs(py));
    const WallAnswer<V> other = resolved_answer(wall, distance, moved, drift, size);
    answer.lift = hn::IfThenElse(resolved, other.lift, answer.lift);
    answer.alpha = hn::IfThenElse(resolved, other.alpha, answer.alpha);
    rest_x = hn::IfThenElse(resolved, hn::MulAdd(other.back, tx, px), px);
    rest_y = hn::IfThenElse(resolved, hn::MulAdd(other.back, ty, py), py);
  }
  const V after = hn::Mul(wall.beta, normal_speed);
  const V new_x = hn::NegMulAdd(answer.lift, wall.nx, rest_x);
  const V new_y = hn::NegMulAdd(answer.lift, wall.ny, rest_y);
  const V new_vx = hn::MulAdd(answer.alpha, tx, hn::Mul(after, wall.nx));
  const V new_vy = hn::MulAdd(answer.alpha, ty, hn::Mul(after, wall.ny));
  hn::Store(hn::IfThenElse(clear, px, new_x), d, x);
  hn::Store(hn::IfThenElse(clear, py, new_y), d, y);
  hn::Store(hn::IfThenElse(clear, ux, new_vx), d, vx);
  hn::Store(hn::IfThenElse(clear, uy, new_vy), d, vy);
}

/// The same at all walls, one wall after another.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void reflect(D d, const std::vector<Wall>& walls, V drift, double* x, double* y,
                        double* vx, double* vy) {
  for (const Wall& wall : walls) reflect(d, in_all_lanes(d, wall), drift, x, y, vx, vy);
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
    return hn::Set(d, static_cast<hn::TFromD<D>>(walls[0].offset));
  }
  template <class D>
  void mirror(D d, hn::Vec<D> drift, double* x, double* y, double* vx, double* vy) const {
    reflect(d, walls, drift, x, y, vx, vy);
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
  void mirror(D d, hn::Vec<D> drift, double* x, double* y, double* vx, double* vy) const {
    reflect(d, walls, drift, x, y, vx, vy);
  }
  const std::vector<Wall>& walls;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
