// The forms of law, walls and rings that the ring kernels are compiled for.
#if defined(BOUNCE_RING_FORMS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_FORMS_INL_HPP
#undef BOUNCE_RING_FORMS_INL_HPP
#else
#define BOUNCE_RING_FORMS_INL_HPP
#endif

#include <memory>

#include "kernels/stepping/ring_columns-inl.hpp"
#include "kernels/stepping/scene_forms.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// Make::of<Law, Walls, R>(arguments...) for the forms the problem needs; those that
/// refuses_ring_form lets through: (3, 5) on any of the rings, the others on three.
template <class Make, class Law, int R, class... Arguments>
std::unique_ptr<Stepper> make_with_walls(const Problem& problem, const Arguments&... arguments) {
  switch (wall_form(problem)) {
    case WallForm::none:
      return Make::template of<Law, NoWalls, R>(problem, arguments...);
    case WallForm::floor:
      return Make::template of<Law, Floor, R>(problem, arguments...);
    case WallForm::any:
      return Make::template of<Law, AnyWalls, R>(problem, arguments...);
  }
  return nullptr;
}

template <class Make, class... Arguments>
std::unique_ptr<Stepper> make_ring_form(const Problem& problem, const RingShape& shape,
                                        const Arguments&... arguments) {
  const LawForm law = law_form(problem.law);
  if (law == LawForm::seven_thirteen) {
    return make_with_walls<Make, FixedLaw<8, 6>, 3>(problem, shape, arguments...);
  }
  if (law == LawForm::two_four) {
    return make_with_walls<Make, FixedLaw<3, 2>, 3>(problem, shape, arguments...);
  }
  switch (shape.rings) {
    case 1:
      return make_with_walls<Make, FixedLaw<4, 2>, 1>(problem, shape, arguments...);
    case 2:
      return make_with_walls<Make, FixedLaw<4, 2>, 2>(problem, shape, arguments...);
    case 3:
      return make_with_walls<Make, FixedLaw<4, 2>, 3>(problem, shape, arguments...);
    case 4:
      return make_with_walls<Make, FixedLaw<4, 2>, 4>(problem, shape, arguments...);
    default:
      return nullptr;
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
