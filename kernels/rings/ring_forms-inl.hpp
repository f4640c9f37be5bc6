// The laws and numbers of rings that the kernels ring and mirror are compiled for: from numbers
// known at run time to types.
#if defined(BOUNCE_RING_FORMS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_FORMS_INL_HPP
#undef BOUNCE_RING_FORMS_INL_HPP
#else
#define BOUNCE_RING_FORMS_INL_HPP
#endif

#include <cstdint>
#include <memory>

#include "kernels/rings/ring_columns-inl.hpp"
#include "kernels/stepping/law_form.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// visit.operator()<Law, R>() for a form of the law and a number of rings that find_ring_form lets
/// through: (3, 5) on any of the rings, the others on three.
template <class Visit>
auto with_ring_form(LawForm law, int rings, const Visit& visit)
    -> decltype(visit.template operator()<FixedLaw<4, 2>, 1>()) {
  if (law == LawForm::seven_thirteen) return visit.template operator()<FixedLaw<8, 6>, 3>();
  if (law == LawForm::two_four) return visit.template operator()<FixedLaw<3, 2>, 3>();
  switch (rings) {
    case 1:
      return visit.template operator()<FixedLaw<4, 2>, 1>();
    case 2:
      return visit.template operator()<FixedLaw<4, 2>, 2>();
    case 3:
      return visit.template operator()<FixedLaw<4, 2>, 3>();
    case 4:
      return visit.template operator()<FixedLaw<4, 2>, 4>();
    default:
      return nullptr;
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
