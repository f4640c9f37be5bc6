// Which vector instructions a kernel uses: one choice for all of them.
//
// A source file with vectors is compiled once for each target, by Highway's foreach_target.h, into
// namespaces N_AVX2 and N_AVX3. Not taken: Highway's own dispatch, which picks one target for the
// whole process. Here each plan has its own, so that two can be compared in one run.
#pragma once

#include <string_view>
#include <vector>

namespace bounce {

/// Vector instruction sets that a kernel can use.
enum class VectorTarget { none, avx2, avx512 };
std::string_view name_of(VectorTarget target);

/// Doubles in one of its vectors.
constexpr int lanes_of(VectorTarget target) {
  return target == VectorTarget::avx512 ? 8 : target == VectorTarget::avx2 ? 4 : 1;
}

/// Vector targets that this processor, its operating system and this build can run, best first.
std::vector<VectorTarget> available_vectors();

}  // namespace bounce

/// `function` as compiled for a target other than none. For the last section of a file that
/// includes foreach_target.h (HWY_ONCE).
#define BOUNCE_COMPILED_FOR(target, function) \
  ((target) == VectorTarget::avx512 ? &N_AVX3::function : &N_AVX2::function)
