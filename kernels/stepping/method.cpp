#include "kernels/stepping/method.hpp"

#include <algorithm>
#include <array>

namespace bounce {
namespace {

constexpr std::array<Stage, 1> listing_stages{{{1.0, 1.0}}};
constexpr std::array<Stage, 2> leapfrog_stages{{{0.5, 1.0}, {0.5, 0.0}}};

constexpr std::array<Method, 2> table{{
    {.name = "listing",
     .description = "semi-implicit Euler, the scheme of the paper's program",
     .source = "Greenspan's listing, labels 5634 to 7123; MODEL 3",
     .stages = listing_stages,
     .order = 1,
     .evaluations = 1,
     .reversible = false,
     .first_same_as_last = false},
    {.name = "leapfrog",
     .description = "velocity Verlet: half a kick, a drift, half a kick",
     .source = "Verlet, Phys. Rev. 159 (1967) 98; Swope et al., J. Chem. Phys. 76 (1982) 637",
     .stages = leapfrog_stages,
     .order = 2,
     .evaluations = 1,
     .reversible = true,
     .first_same_as_last = true},
}};

}  // namespace

std::span<const Method> methods() { return table; }

const Method* find_method(std::string_view name) {
  const auto* found =
      std::find_if(table.begin(), table.end(), [name](const Method& m) { return m.name == name; });
  return found == table.end() ? nullptr : found;
}

}  // namespace bounce
