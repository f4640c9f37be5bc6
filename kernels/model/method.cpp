#include "kernels/model/method.hpp"

#include <algorithm>
#include <array>

namespace bounce {
namespace {

constexpr std::array<Stage, 1> listing_stages{{{1.0, 1.0}}};
constexpr std::array<Stage, 2> leapfrog_stages{{{0.5, 1.0}, {0.5, 0.0}}};

// A palindrome of n kicks with n - 1 drifts between them, from the first half of either and, where
// there is one, the middle.
template <std::size_t n>
constexpr std::array<Stage, n> kick_to_kick(const std::array<double, (n + 1) / 2>& kicks,
                                            const std::array<double, n / 2>& drifts) {
  std::array<Stage, n> stages{};
  for (std::size_t i = 0; i < n; ++i) {
    stages[i].kick = kicks[std::min(i, n - 1 - i)];
    if (i + 1 < n) stages[i].drift = drifts[std::min(i, n - 2 - i)];
  }
  return stages;
}

// Three leapfrogs of the parts a, b, a: 2 a + b = 1, and the third-order error of their product,
// that of leapfrog times 2 a^3 + b^3, vanishes.
constexpr std::array<Stage, 4> yoshida_4_stages = [] {
  constexpr double cube_root_of_2 = 1.2599210498948731648;
  constexpr double a = 1.0 / (2.0 - cube_root_of_2), b = 1.0 - 2.0 * a;
  return kick_to_kick<4>({0.5 * a, 0.5 * (a + b)}, {a, b});
}();

// The numbers of the sources below have 15 or 16 decimals; what they have to sum up to gives one
// number of each kind.

constexpr std::array<Stage, 5> pefrl_stages = [] {
  constexpr double xi = 0.1786178958448091, lambda = -0.2123418310626054;
  constexpr double chi = -0.06626458266981849;
  constexpr double outer = 0.5 * (1.0 - 2.0 * lambda), middle = 1.0 - 2.0 * (chi + xi);
  return std::array<Stage, 5>{
      {{0.0, xi}, {outer, chi}, {lambda, middle}, {lambda, chi}, {outer, xi}}};
}();

constexpr std::array<Stage, 7> blanes_moan_4_stages = [] {
  constexpr double b1 = 0.0829844064174052, b2 = 0.396309801498368, b3 = -0.0390563049223486;
  constexpr double a1 = 0.245298957184271, a2 = 0.604872665711080;
  return kick_to_kick<7>({b1, b2, b3, 1.0 - 2.0 * (b1 + b2 + b3)}, {a1, a2, 0.5 - (a1 + a2)});
}();

constexpr std::array<Stage, 12> blanes_moan_6_stages = [] {
  constexpr double b1 = 0.0414649985182624, b2 = 0.198128671918067, b3 = -0.0400061921041533;
  constexpr double b4 = 0.0752539843015807, b5 = -0.0115113874206879;
  constexpr double a1 = 0.123229775946271, a2 = 0.290553797799558, a3 = -0.127049212625417;
  constexpr double a4 = -0.246331761062075, a5 = 0.357208872795928;
  return kick_to_kick<12>({b1, b2, b3, b4, b5, 0.5 - (b1 + b2 + b3 + b4 + b5)},
                          {a1, a2, a3, a4, a5, 1.0 - 2.0 * (a1 + a2 + a3 + a4 + a5)});
}();

constexpr std::array<Method, 6> table{{
    {.name = "listing",
     .description = "semi-implicit Euler, the scheme of the paper's program",
     .source = "Greenspan's listing, labels 5634 to 7123",
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
    {.name = "yoshida-4",
     .description = "three leapfrogs, the middle one backwards",
     .source = "Yoshida, Phys. Lett. A 150 (1990) 262",
     .stages = yoshida_4_stages,
     .order = 4,
     .evaluations = 3,
     .reversible = true,
     .first_same_as_last = true},
    {.name = "pefrl",
     .description = "position-extended, like Forest and Ruth's; drift to drift",
     .source = "Omelyan, Mryglod, Folk, Comput. Phys. Commun. 146 (2002) 188",
     .stages = pefrl_stages,
     .order = 4,
     .evaluations = 4,
     .reversible = true,
     .first_same_as_last = true},
    {.name = "blanes-moan-4",
     .description = "Runge-Kutta-Nystroem, symplectic, SRKN_6^b",
     .source = "Blanes, Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3",
     .stages = blanes_moan_4_stages,
     .order = 4,
     .evaluations = 6,
     .reversible = true,
     .first_same_as_last = true},
    {.name = "blanes-moan-6",
     .description = "Runge-Kutta-Nystroem, symplectic, SRKN_11^b",
     .source = "Blanes, Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3",
     .stages = blanes_moan_6_stages,
     .order = 6,
     .evaluations = 11,
     .reversible = true,
     .first_same_as_last = true},
}};

}  // namespace

StageSequence stage_sequence(const Method& method) {
  StageSequence sequence{{method.stages.begin(), method.stages.end()}, {}};
  if (!method.first_same_as_last) return sequence;
  sequence.fresh.pop_back();
  sequence.joined = sequence.fresh;
  const Stage held = method.stages.back();
  sequence.joined.front().kick += held.kick;
  sequence.joined.front().drift += held.drift;
  return sequence;
}

std::span<const Method> methods() { return table; }

const Method* find_method(std::string_view name) {
  const auto* found =
      std::find_if(table.begin(), table.end(), [name](const Method& m) { return m.name == name; });
  return found == table.end() ? nullptr : found;
}

}  // namespace bounce
