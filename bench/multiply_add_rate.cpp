#include "bench/multiply_add_rate.hpp"

#include <benchmark/benchmark.h>

#include <chrono>

namespace bounce {
#ifndef BOUNCE_MULTIPLY_ADD_RATE_ROUNDS  // this file is read once a target
#define BOUNCE_MULTIPLY_ADD_RATE_ROUNDS
constexpr int rounds = 100'000;
constexpr int side_by_side = 10;
#endif
}  // namespace bounce

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/multiply_add_rate.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Ten side by side: two ports, four or five cycles from a sum to its next term. Each starts from a
// value of its own: ten equal chains the compiler would compute as one, and the rate would be ten
// times that of a chain, whatever the ports can do. The result keeps it from leaving the work out.
HWY_NOINLINE double multiply_add(double start) {
  const hn::ScalableTag<double> d;
  const auto factor = hn::Set(d, 0.5);
  const auto term = hn::Set(d, start);
  const auto begin = [&](int chain) HWY_ATTR { return hn::Set(d, start * chain); };
  auto a = begin(1), b = begin(2), c = begin(3), e = begin(4), f = begin(5);
  auto g = begin(6), h = begin(7), i = begin(8), j = begin(9), k = begin(10);
  for (int round = 0; round < rounds; ++round) {
    a = hn::MulAdd(a, factor, term);
    b = hn::MulAdd(b, factor, term);
    c = hn::MulAdd(c, factor, term);
    e = hn::MulAdd(e, factor, term);
    f = hn::MulAdd(f, factor, term);
    g = hn::MulAdd(g, factor, term);
    h = hn::MulAdd(h, factor, term);
    i = hn::MulAdd(i, factor, term);
    j = hn::MulAdd(j, factor, term);
    k = hn::MulAdd(k, factor, term);
  }
  const auto half = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), f);
  return hn::GetLane(hn::Add(half, hn::Add(hn::Add(hn::Add(g, h), hn::Add(i, j)), k)));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {

double multiply_add_rate(VectorTarget target) {
  const auto start = std::chrono::steady_clock::now();
  double result =
      target == VectorTarget::avx512 ? N_AVX3::multiply_add(0.25) : N_AVX2::multiply_add(0.25);
  benchmark::DoNotOptimize(result);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  return static_cast<double>(rounds) * side_by_side / time.count();
}

}  // namespace bounce
#endif
