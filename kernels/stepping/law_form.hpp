// Which form of the pair law a problem needs. Kernels are compiled for each form, so that no step
// asks which exponents the law has.
#pragma once

#include <string>

#include "kernels/model/problem.hpp"
#include "kernels/stepping/kernel.hpp"

namespace bounce {

/// By the exponents (p, q): three pairs, any odd ones, any.
enum class LawForm { three_five, seven_thirteen, two_four, odd, general };
LawForm law_form(PairLaw law);

/// A plan that says of the problem's law and walls what holds for every kernel that is compiled for
/// the form of the law: to be filled by the kernel.
Plan plan_for(const Problem& problem);

}  // namespace bounce
