#include "kernels/model/pair_law.hpp"

#include <cmath>

namespace bounce {
namespace {

// 1/R^e at r2 = R^2: without a root for even e, with one for odd e, else through pow.
double inverse_power(double r2, double e) {
  const int n = e >= 0.0 && e <= 64.0 ? static_cast<int>(e) : 0;
  const bool whole = static_cast<double>(n) == e;  // std::floor would be a call
  if (!whole) return std::pow(r2, -0.5 * e);
  const double u = 1.0 / r2;
  double power = n % 2 == 1 ? std::sqrt(u) : 1.0;
  for (int k = 0; k < n / 2; ++k) power *= u;
  return power;
}

// Potential whose force is 1/R^e.
double potential_of_power(double r2, double e) {
  return e == 1.0 ? -0.5 * std::log(r2) : inverse_power(r2, e - 1.0) / (e - 1.0);
}

}  // namespace

double force_over_distance(PairLaw law, const BondClass& bond, double r2) {
  return bond.repulsion * inverse_power(r2, law.q + 1.0) -
         bond.attraction * inverse_power(r2, law.p + 1.0);
}

double potential(PairLaw law, const BondClass& bond, double r2) {
  return bond.repulsion * potential_of_power(r2, law.q) -
         bond.attraction * potential_of_power(r2, law.p);
}

Stiffness stiffness(PairLaw law, const BondClass& bond, double r2) {
  const double repulsion = bond.repulsion * inverse_power(r2, law.q + 1.0);
  const double attraction = bond.attraction * inverse_power(r2, law.p + 1.0);
  return {law.q * repulsion - law.p * attraction, attraction - repulsion};
}

}  // namespace bounce
