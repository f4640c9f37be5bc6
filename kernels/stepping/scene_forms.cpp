#include "kernels/stepping/scene_forms.hpp"

#include <cmath>

namespace bounce {

LawForm law_form(PairLaw law) {
  const auto is = [law](double p, double q) { return law.p == p && law.q == q; };
  if (is(3, 5)) return LawForm::three_five;
  if (is(7, 13)) return LawForm::seven_thirteen;
  if (is(2, 4)) return LawForm::two_four;
  const bool odd = std::fmod(law.p, 2.0) == 1.0 && std::fmod(law.q, 2.0) == 1.0;
  return odd ? LawForm::odd : LawForm::general;
}

std::string describe(LawForm form) {
  switch (form) {
    case LawForm::three_five:
      return "(3, 5) without a root";
    case LawForm::seven_thirteen:
      return "(7, 13) without a root";
    case LawForm::two_four:
      return "(2, 4) with one root";
    case LawForm::odd:
      return "odd p and q without a root";
    case LawForm::general:
      break;
  }
  return "any p and q through pow";
}

WallForm wall_form(const Model& model) {
  if (model.walls.empty()) return WallForm::none;
  const Vec2 normal = model.walls.front().normal;
  const bool floor = model.walls.size() == 1 && normal.x == 0.0 && normal.y == 1.0;
  return floor ? WallForm::floor : WallForm::any;
}

std::string describe(WallForm form) {
  switch (form) {
    case WallForm::none:
      return "none";
    case WallForm::floor:
      return "one horizontal floor";
    case WallForm::any:
      break;
  }
  return "any number in any direction";
}

std::vector<std::string> left_out(LawForm law, WallForm walls) {
  std::vector<std::string> names;
  if (law != LawForm::two_four && law != LawForm::general) names.emplace_back("square root");
  if (law != LawForm::general) names.emplace_back("pow");
  if (law != LawForm::general && law != LawForm::odd) names.emplace_back("variable exponents");
  if (walls == WallForm::none) names.emplace_back("wall test and reflection");
  if (walls == WallForm::floor) names.emplace_back("walls in other directions");
  return names;
}

}  // namespace bounce
