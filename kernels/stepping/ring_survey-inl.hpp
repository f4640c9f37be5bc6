// What free flight must know (free_flight.hpp) of columns of rings, in vectors.
#if defined(BOUNCE_RING_SURVEY_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_SURVEY_INL_HPP
#undef BOUNCE_RING_SURVEY_INL_HPP
#else
#define BOUNCE_RING_SURVEY_INL_HPP
#endif

#include <hwy/highway.h>

#include <vector>

#include "kernels/stepping/ring_columns-inl.hpp"
#include "kernels/stepping/survey_sums-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Adds bonds first, first + 1, ... of `columns` columns from `at` on; behind the last one the next
/// column's positions must stand. Each kind of bond is a pass of its own: two vectors are alive.
template <class Columns, int first = 0>
HWY_INLINE void survey_bonds(const Columns& physics, const double* at, size_t columns,
                             FlightSurvey& to) {
  constexpr auto p = Columns::place(first);
  SurveySpan<typename Columns::Tag> r2;
  for (const double* end = at + columns * Columns::block; at != end; at += Columns::block) {
    const double* other = p.next ? at + Columns::block : at;
    const auto dx = hn::Sub(Columns::x_of(at, p.from), Columns::x_of(other, p.to));
    const auto dy = hn::Sub(Columns::y_of(at, p.from), Columns::y_of(other, p.to));
    r2.add(hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
  }
  to.r2[static_cast<size_t>(physics.bond_class(first))].add(r2.of_lanes());
  if constexpr (first + 1 < Columns::bonds_a_column) {
    survey_bonds<Columns, first + 1>(physics, at - columns * Columns::block, columns, to);
  }
}

/// Adds the particles of `columns` columns from `at` on.
template <class Columns>
HWY_INLINE void survey_particles(const std::vector<Wall>& walls, const double* at, size_t columns,
                                 FlightSurvey& to) {
  SurveySums<typename Columns::Tag> sums(walls);
  for (const double* end = at + columns * Columns::block; at != end; at += Columns::block) {
    const double* velocities = at + Columns::positions;
    for (int r = 0; r < Columns::rings; ++r) {
      sums.add(Columns::x_of(at, r), Columns::y_of(at, r), Columns::x_of(velocities, r),
               Columns::y_of(velocities, r));
    }
  }
  sums.add_to(to);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
