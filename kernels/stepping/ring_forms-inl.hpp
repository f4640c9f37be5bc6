// The forms of law, walls and rings that the ring kernels are compiled for.
#if defined(BOUNCE_RING_FORMS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_FORMS_INL_HPP
#undef BOUNCE_RING_FORMS_INL_HPP
#else
#define BOUNCE_RING_FORMS_INL_HPP
#endif

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "kernels/stepping/free_flight.hpp"
#include "kernels/stepping/ring_columns-inl.hpp"
#include "kernels/stepping/scene_forms.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// visit.operator()<Walls>() for the form of the problem's walls.
template <class Visit>
auto with_walls(const Problem& problem, const Visit& visit)
    -> decltype(visit.template operator()<NoWalls>()) {
  switch (wall_form(problem)) {
    case WallForm::none:
      return visit.template operator()<NoWalls>();
    case WallForm::floor:
      return visit.template operator()<Floor>();
    case WallForm::any:
      return visit.template operator()<AnyWalls>();
  }
  return nullptr;
}

/// The walls of a problem, for kernels that step the same particles with and without them.
class WallsInTurns {
 public:
  explicit WallsInTurns(const Problem& problem, bool free_flight)
      : form_(wall_form(problem)), walls_(problem.walls) {
    if (free_flight && form_ != WallForm::none) turns_.emplace(problem);
  }

  /// move(walls, n) until `steps` steps are taken, `walls` being of the form that is needed;
  /// survey(walls, FlightSurvey&) looks at the present state.
  template <class Survey, class Move>
  void advance(std::int64_t steps, const Survey& survey, const Move& move) {
    if (!turns_) return with_form(form_, steps, move);
    turns_->advance(
        steps, [&](FlightSurvey& to) { survey(walls_, to); },
        [&](std::int64_t n, bool free) { with_form(free ? WallForm::none : form_, n, move); });
  }

  /// The same with the wall test always.
  template <class Move>
  void advance_walled(std::int64_t steps, const Move& move) const {
    with_form(form_, steps, move);
  }

  /// The state has been replaced.
  void forget() {
    if (turns_) turns_->forget();
  }

 private:
  template <class Move>
  void with_form(WallForm form, std::int64_t n, const Move& move) const {
    switch (form) {
      case WallForm::none:
        return move(NoWalls(walls_), n);
      case WallForm::floor:
        return move(Floor(walls_), n);
      case WallForm::any:
        return move(AnyWalls(walls_), n);
    }
  }

  WallForm form_;
  std::vector<Wall> walls_;
  std::optional<FlightTurns> turns_;
};

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
