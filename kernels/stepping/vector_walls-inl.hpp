// The wall rules on vectors; wall_rule.hpp has them for one particle, and says why they are so. A
// particle with not (n.x > offset) is mirrored, its tangential velocity multiplied by alpha, its
// normal velocity by beta; or, where the contact is resolved, given back the part of the drift that
// it spent behind the wall. Not-a-number is not mirrored.
//
// Why it is built so
//  1. Walls come after a sweep, each in one more pass over what was just moved, while that is in
//     L1. For a level floor the least height is enough, which a kernel may find within its sweep.
//  2. Only a vector with a particle behind a wall is reflected, out of line. So alpha, beta and the
//     rule cost nothing while nothing touches, and no kernel is compiled for its walls.
//  3. The resolved rule sees from the state alone whether a particle rests: it began its drift on
//     the wall. So a state is still positions and velocities, and no contacts have to be remembered
//     from step to step or saved.
//
// Not taken: the test of each particle within the sweep, compiled for the kind of walls (two walls
// cost more, and there are three forms to compile); a proof for how many steps nobody can reach a
// wall, and no test in these ("Tried and taken out" in verify/README.md has what they gained).
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

/// A wall's numbers, the same in all lanes.
template <class V>
struct WallVectors {
  V nx, ny, offset, alpha, beta;

  HWY_INLINE WallVectors(hn::DFromV<V> d, const Wall& wall)
      : nx(hn::Set(d, wall.normal.x)),
        ny(hn::Set(d, wall.normal.y)),
        offset(hn::Set(d, wall.offset)),
        alpha(hn::Set(d, wall.alpha)),
        beta(hn::Set(d, wall.beta)) {}
};

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
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const V slack = hn::Mul(hn::Set(d, resting_slack), hn::Add(size, hn::Abs(wall.offset)));
  const auto resting = hn::And(hn::And(hn::Eq(wall.beta, zero), hn::Lt(wall.alpha, one)),
                               hn::Le(hn::Sub(distance, moved), slack));
  const V alpha = hn::IfThenElse(resting, zero, wall.alpha);
  const V part = hn::Div(distance, moved);
  // Not above 0, or not a number, where the drift did not lead into the wall.
  const V behind =
      hn::IfThenElse(hn::Gt(part, zero), hn::Min(part, hn::Set(d, most_part_behind)), zero);
  return {hn::Mul(hn::Sub(one, wall.beta), distance), alpha,
          hn::Mul(hn::Mul(behind, drift), hn::Sub(alpha, one))};
}

/// What one wall does to a vector of particles at (x, y), after a drift of `drift` (s).
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE void reflect(D d, const Wall& wall, V drift, double* x, double* y, double* vx,
                          double* vy) {
  const WallVectors<V> w(d, wall);
  const V px = hn::Load(d, x), py = hn::Load(d, y);
  const V ux = hn::Load(d, vx), uy = hn::Load(d, vy);
  const V distance = distance_from(w, px, py);
  // Not-a-number stays where it is, whatever stands beside it in the vector; a stage that steps
  // back meets no wall.
  const V zero = hn::Zero(d);
  const auto clear = hn::Or(hn::Not(hn::Le(distance, zero)), hn::Lt(drift, zero));
  const V normal_speed = hn::MulAdd(w.nx, ux, hn::Mul(w.ny, uy));
  const V tx = hn::NegMulAdd(normal_speed, w.nx, ux);
  const V ty = hn::NegMulAdd(normal_speed, w.ny, uy);
  WallAnswer<V> answer = mirror_answer(w, distance);
  V from_x = px, from_y = py;
  if (wall.contact != Contact::listing) {
    const V moved = hn::Mul(drift, normal_speed), size = hn::Add(hn::Abs(px), hn::Abs(py));
    answer = resolved_answer(w, distance, moved, drift, size);
    from_x = hn::MulAdd(answer.back, tx, px);
    from_y = hn::MulAdd(answer.back, ty, py);
  }
  const V after = hn::Mul(w.beta, normal_speed);
  const V new_x = hn::NegMulAdd(answer.lift, w.nx, from_x);
  const V new_y = hn::NegMulAdd(answer.lift, w.ny, from_y);
  const V new_vx = hn::MulAdd(answer.alpha, tx, hn::Mul(after, w.nx));
  const V new_vy = hn::MulAdd(answer.alpha, ty, hn::Mul(after, w.ny));
  hn::Store(hn::IfThenElse(clear, px, new_x), d, x);
  hn::Store(hn::IfThenElse(clear, py, new_y), d, y);
  hn::Store(hn::IfThenElse(clear, ux, new_vx), d, vx);
  hn::Store(hn::IfThenElse(clear, uy, new_vy), d, vy);
}

/// Where the coordinates of a vector of particles stand.
struct Place {
  const double *x, *y;
};

/// The least of value(k, j) over 0 <= k < count and 0 <= j < width, lane by lane, not-a-number
/// apart: `width` minima that do not wait for each other.
template <size_t width, class D, class Value>
HWY_INLINE hn::Vec<D> least(D d, size_t count, const Value& value) {
  hn::Vec<D> found[width];
  for (size_t j = 0; j < width; ++j) found[j] = hn::Set(d, hwy::HighestValue<double>());
  for (size_t k = 0; k < count; ++k) {
    for (size_t j = 0; j < width; ++j) found[j] = hn::Min(value(k, j), found[j]);
  }
  for (size_t j = 1; j < width; ++j) found[0] = hn::Min(found[j], found[0]);
  return found[0];
}

/// Whether the particle that is nearest to the wall is the lowest one.
inline bool is_floor(const Wall& wall) { return wall.normal.x == 0.0 && wall.normal.y > 0.0; }

/// Whether what stands at these heights, cm, is in front of a floor.
template <class D>
HWY_INLINE bool above(D d, const Wall& floor, hn::Vec<D> heights) {
  const WallVectors<hn::Vec<D>> w(d, floor);
  return hn::AllTrue(d, hn::Gt(hn::MulSub(w.ny, heights, w.offset), hn::Zero(d)));
}

/// Whether all particles are in front of a wall; not-a-number counts as in front. place(k, j) is
/// where vector j, 0 .. width - 1, of group k, 0 .. count - 1, stands.
template <size_t width, class D, class PlaceOf>
HWY_INLINE bool in_front(D d, const Wall& wall, size_t count, const PlaceOf& place) {
  if (is_floor(wall)) {
    const auto height = [&](size_t k, size_t j) HWY_ATTR { return hn::Load(d, place(k, j).y); };
    return above(d, wall, least<width>(d, count, height));
  }
  const WallVectors<hn::Vec<D>> w(d, wall);
  const auto distance = [&](size_t k, size_t j) HWY_ATTR {
    const Place at = place(k, j);
    return distance_from(w, hn::Load(d, at.x), hn::Load(d, at.y));
  };
  return hn::AllTrue(d, hn::Gt(least<width>(d, count, distance), hn::Zero(d)));
}

/// Whether `vectors` vectors are in front of all walls; place(k) is where vector k stands.
template <class D, class PlaceOf>
HWY_INLINE bool all_in_front(D d, const std::vector<Wall>& walls, size_t vectors,
                             const PlaceOf& place) {
  constexpr size_t width = 4;
  const size_t groups = vectors / width;
  const auto in_groups = [&place](size_t k, size_t j) { return place(k * width + j); };
  const auto rest = [&place, groups](size_t k, size_t) { return place(groups * width + k); };
  for (const Wall& wall : walls) {
    if (HWY_UNLIKELY(!(in_front<width>(d, wall, groups, in_groups) &&
                       in_front<1>(d, wall, vectors % width, rest)))) {
      return false;
    }
  }
  return true;
}

/// One vector of particles at all walls, one wall after another, if any of them is behind any wall.
template <class D>
HWY_INLINE void meet_walls(D d, const std::vector<Wall>& walls, hn::Vec<D> drift, double* x,
                           double* y, double* vx, double* vy) {
  if (all_in_front(d, walls, 1, [=](size_t) { return Place{x, y}; })) return;
  for (const Wall& wall : walls) reflect(d, wall, drift, x, y, vx, vy);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
