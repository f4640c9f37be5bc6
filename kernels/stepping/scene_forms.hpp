// Which forms of the law and of the walls a problem needs: what the kernels are compiled for.
#pragma once

#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {

enum class LawForm { three_five, seven_thirteen, two_four, odd, general };
LawForm law_form(PairLaw law);
/// For people: which powers and roots the compiled form takes.
std::string describe(LawForm form);

enum class WallForm { none, floor, any };  ///< floor: one wall with normal (0, 1)
WallForm wall_form(const Model& model);
std::string describe(WallForm form);

/// What code of these forms does not contain, for people.
std::vector<std::string> left_out(LawForm law, WallForm walls);

}  // namespace bounce
