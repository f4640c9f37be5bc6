// Powers of a bond's length, for sums over all bonds: the kind of power is decided once, not for
// each bond.
#pragma once

#include <cmath>

#include "kernels/model/pair_law.hpp"

namespace bounce {

/// 1/R^exponent from u = 1/R^2: whole exponents by multiplication, odd ones with a root.
class PowerOf {
 public:
  explicit PowerOf(double exponent) : exponent_(exponent) {
    const bool whole = exponent == std::floor(exponent) && exponent >= 1.0 && exponent <= 64.0;
    if (whole) whole_ = static_cast<int>(exponent);
  }
  [[nodiscard]] double operator()(double u) const {
    switch (whole_) {  // the paper's law: no loop
      case 2:
        return u;
      case 4:
        return u * u;
      case 6:
        return u * u * u;
      default:
        return other(u);
    }
  }

 private:
  [[nodiscard]] double other(double u) const {
    if (whole_ == 0) return std::pow(u, 0.5 * exponent_);
    double power = whole_ % 2 == 1 ? std::sqrt(u) : 1.0;
    for (int k = 0; k < whole_ / 2; ++k) power *= u;
    return power;
  }

  double exponent_;
  int whole_ = 0;  // the exponent, or 0
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

/// Stiffness along and across as stiffness() has it, from R^2.
class StiffnessOf {
 public:
  explicit StiffnessOf(PairLaw law)
      : law_(law), attraction_(law.p + 1.0), repulsion_(law.q + 1.0) {}
  [[nodiscard]] Stiffness operator()(const BondClass& bond, double r2) const {
    const double u = 1.0 / r2;
    const double repulsion = bond.repulsion * repulsion_(u);
    const double attraction = bond.attraction * attraction_(u);
    return {law_.q * repulsion - law_.p * attraction, attraction - repulsion};
  }

 private:
  PairLaw law_;
  PowerOf attraction_, repulsion_;
};

}  // namespace bounce
