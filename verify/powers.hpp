// Powers of a bond's length, for sums over all bonds: the kind of power is decided once, not a
// bond.
#pragma once

#include <cmath>

#include "kernels/model/pair_law.hpp"

namespace bounce {

/// 1/R^exponent from u = 1/R^2: whole even exponents, which the laws without a root have, by
/// multiplication.
class PowerOf {
 public:
  explicit PowerOf(double exponent) : exponent_(exponent) {
    const double half = 0.5 * exponent;
    if (half == std::floor(half) && half >= 1.0 && half <= 32.0) halves_ = static_cast<int>(half);
  }
  [[nodiscard]] double operator()(double u) const {
    if (halves_ == 0) return std::pow(u, 0.5 * exponent_);
    double power = u;
    for (int k = 1; k < halves_; ++k) power *= u;
    return power;
  }

 private:
  double exponent_;
  int halves_ = 0;  // 0: not a whole even exponent
};

/// V(R) as potential() has it, from R^2.
class PotentialOf {
 public:
  explicit PotentialOf(PairLaw law)
      : law_(law), attraction_(law.p - 1.0), repulsion_(law.q - 1.0) {}
  [[nodiscard]] double operator()(const BondClass& bond, double r2) const {
    if (law_.p == 1.0 || law_.q == 1.0) return potential(law_, bond, r2);  // a logarithm
    const double u = 1.0 / r2;
    return bond.repulsion * repulsion_(u) / (law_.q - 1.0) -
           bond.attraction * attraction_(u) / (law_.p - 1.0);
  }

 private:
  PairLaw law_;
  PowerOf attraction_, repulsion_;
};

}  // namespace bounce
