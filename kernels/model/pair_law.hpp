// The force of a bond, -G/R^p + H/R^q at a distance R (paper, equation 1), its potential and its
// stiffness.
#pragma once

namespace bounce {

/// Exponents of the law, q > p > 0.
struct PairLaw {
  double p = 3.0;
  double q = 5.0;
};

/// Constants of one class of bonds: G = attraction, H = repulsion = G R0^(q-p); rest = R0 (cm).
struct BondClass {
  double attraction = 0.0;
  double repulsion = 0.0;
  double rest = 0.0;
};

/// F(R)/R at the squared distance r2 > 0 (cm^2); positive = repulsion. Times (dx, dy) = x_i - x_j
/// it is the force on particle i.
double force_over_distance(PairLaw law, const BondClass& bond, double r2);

/// Potential V(R), with F = -dV/dR: zero at infinity (p > 1), a logarithm for p = 1 or q = 1.
double potential(PairLaw law, const BondClass& bond, double r2);

/// Second derivatives of V at a distance R, g/s^2: V''(R) = q H/R^(q+1) - p G/R^(p+1) along the
/// bond, V'(R)/R = -F(R)/R across it. With the unit vector e of the bond, the second derivative of
/// V by x_i - x_j is the matrix along e e^T + across (1 - e e^T).
struct Stiffness {
  double along = 0.0;
  double across = 0.0;
};

/// The stiffness at the squared distance r2 > 0 (cm^2).
Stiffness stiffness(PairLaw law, const BondClass& bond, double r2);

}  // namespace bounce
