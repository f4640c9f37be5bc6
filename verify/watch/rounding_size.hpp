// How much of a difference rounding explains.
#pragma once

#include <cmath>

namespace bounce {

/// Greatest relative error of one rounding to nearest, 2^-53.
inline constexpr double unit_roundoff = 0x1p-53;

/// The size that roundings explain: `worst` if all of them have one sign, `likely()` (one standard
/// deviation) if they are independent. One rounding of a number of size a is off by at most
/// 2^-53 a, and, anywhere within that, has the variance (2^-53 a)^2 / 3.
struct RoundingSize {
  double worst = 0.0;
  double variance = 0.0;

  /// `count` roundings of numbers of that size.
  void add(double size, double count = 1.0) {
    const double each = unit_roundoff * std::abs(size);
    worst += count * each;
    variance += count * each * each * third;
  }
  /// All of `other`, `times` over.
  void add(const RoundingSize& other, double times = 1.0) {
    worst += times * other.worst;
    variance += times * other.variance;
  }
  [[nodiscard]] double likely() const { return std::sqrt(variance); }
  template <class Words>
  void serialize(Words& words) {
    words(worst, variance);
  }

 private:
  static constexpr double third = 1.0 / 3.0;  // no division: ledgers add thousands a sample
};

}  // namespace bounce
