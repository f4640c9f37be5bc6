#include "kernels/stepping/law_form.hpp"

#include <cmath>

#include "kernels/model/wall_rule.hpp"

namespace bounce {
namespace {

// For people: which powers and roots the compiled form takes.
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

std::string describe(const std::vector<Wall>& walls) {
  if (walls.empty()) return "none";
  const std::string number = walls.size() == 1 ? "one" : std::to_string(walls.size());
  return number + ", contact " + (any_resolved(walls) ? "resolved" : "listing");
}

// What code of this form does not contain.
std::vector<std::string> left_out(LawForm law) {
  std::vector<std::string> names;
  if (law != LawForm::two_four && law != LawForm::general) names.emplace_back("square root");
  if (law != LawForm::general) names.emplace_back("pow");
  if (law != LawForm::general && law != LawForm::odd) names.emplace_back("variable exponents");
  return names;
}

}  // namespace

LawForm law_form(PairLaw law) {
  const auto is = [law](double p, double q) { return law.p == p && law.q == q; };
  if (is(3, 5)) return LawForm::three_five;
  if (is(7, 13)) return LawForm::seven_thirteen;
  if (is(2, 4)) return LawForm::two_four;
  const bool odd = std::fmod(law.p, 2.0) == 1.0 && std::fmod(law.q, 2.0) == 1.0;
  return odd ? LawForm::odd : LawForm::general;
}

Plan plan_for(const Problem& problem) {
  const LawForm law = law_form(problem.law);
  Plan plan;
  plan.law = describe(law);
  plan.walls = describe(problem.walls);
  plan.left_out = left_out(law);
  return plan;
}

}  // namespace bounce
