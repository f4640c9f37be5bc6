// The pair law on vectors: with u = 1/R^2, F/R = P (H Q - G), P = u^((p+1)/2), Q = u^((q-p)/2).
// There is one type for each form of the law (law_form.hpp), and kernels are compiled for each.
#if defined(BOUNCE_VECTOR_LAW_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_VECTOR_LAW_INL_HPP
#undef BOUNCE_VECTOR_LAW_INL_HPP
#else
#define BOUNCE_VECTOR_LAW_INL_HPP
#endif

#include <hwy/highway.h>

#include <cmath>

#include "kernels/model/pair_law.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// u^(N/2), by squaring; a root only if N is odd.
template <int N, class V>
HWY_INLINE V half_power(V u) {
  static_assert(N >= 1);
  if constexpr (N == 1) {
    return hn::Sqrt(u);
  } else if constexpr (N == 2) {
    return u;
  } else if constexpr (N % 4 == 0) {
    const V half = half_power<N / 2>(u);
    return hn::Mul(half, half);
  } else {
    return hn::Mul(half_power<N - 2>(u), u);
  }
}

/// Exponents known when compiled: A = p + 1, B = q - p. (3, 5) is FixedLaw<4, 2>: two
/// multiplications and one fused multiply-subtract.
template <int A, int B>
struct FixedLaw {
  explicit FixedLaw(PairLaw) {}
  template <class D, class V>
  HWY_INLINE V force_over_distance(D, V u, V attraction, V repulsion) const {
    return hn::Mul(half_power<A>(u), hn::MulSub(repulsion, half_power<B>(u), attraction));
  }
};

/// Any odd p and q: whole powers of u, no root.
struct OddLaw {
  explicit OddLaw(PairLaw law)
      : p_power(static_cast<int>((law.p + 1.0) / 2.0)),
        gap_power(static_cast<int>((law.q - law.p) / 2.0)) {}
  template <class D, class V>
  HWY_INLINE V force_over_distance(D, V u, V attraction, V repulsion) const {
    V outer = u;
    for (int k = 1; k < p_power; ++k) outer = hn::Mul(outer, u);
    V inner = u;
    for (int k = 1; k < gap_power; ++k) inner = hn::Mul(inner, u);
    return hn::Mul(outer, hn::MulSub(repulsion, inner, attraction));
  }
  int p_power;
  int gap_power;
};

/// Any p and q, through the scalar pow, lane by lane: right rather than fast.
struct GeneralLaw {
  explicit GeneralLaw(PairLaw law)
      : p_power(0.5 * (law.p + 1.0)), gap_power(0.5 * (law.q - law.p)) {}
  template <class D, class V>
  HWY_INLINE V force_over_distance(D d, V u, V attraction, V repulsion) const {
    constexpr size_t lanes = hn::MaxLanes(D());
    HWY_ALIGN double base[lanes];
    HWY_ALIGN double outer[lanes];
    HWY_ALIGN double inner[lanes];
    hn::Store(u, d, base);
    for (size_t l = 0; l < lanes; ++l) {
      outer[l] = std::pow(base[l], p_power);
      inner[l] = std::pow(base[l], gap_power);
    }
    return hn::Mul(hn::Load(d, outer), hn::MulSub(repulsion, hn::Load(d, inner), attraction));
  }
  double p_power;
  double gap_power;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
