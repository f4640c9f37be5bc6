#include "kernels/stepping/vector_target.hpp"

#include <hwy/targets.h>

#include <cstdint>

namespace bounce {

std::string_view name_of(VectorTarget target) {
  switch (target) {
    case VectorTarget::avx2:
      return "avx2";
    case VectorTarget::avx512:
      return "avx512";
    case VectorTarget::none:
      break;
  }
  return "none";
}

std::vector<VectorTarget> available_vectors() {
  std::vector<VectorTarget> available;
  const auto targets = static_cast<std::int64_t>(hwy::SupportedTargets());
  // Highway 1.0.3 asks the processor, the compiler's check also the operating system, which may not
  // save the wide registers.
  const bool saves_512 = __builtin_cpu_supports("avx512f") != 0;
  const bool saves_256 = __builtin_cpu_supports("avx2") != 0;
  if ((targets & HWY_AVX3) != 0 && saves_512) available.push_back(VectorTarget::avx512);
  if ((targets & HWY_AVX2) != 0 && saves_256) available.push_back(VectorTarget::avx2);
  return available;
}

}  // namespace bounce
