#include <vector>

#include "kernels/csr/csr.hpp"
#include "kernels/rings/mirror.hpp"
#include "kernels/plan/plan.hpp"
#include "kernels/rings/ring.hpp"
#include "kernels/rings/rings.hpp"
#include "kernels/csr/strict.hpp"

namespace bounce {

std::span<const KernelEntry> kernels() {
  static const std::vector<KernelEntry> entries{mirror_entry(), ring_entry(), rings_entry(),
                                                csr_entry(), strict_entry()};
  return entries;
}

}  // namespace bounce
