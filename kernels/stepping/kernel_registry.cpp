#include <vector>

#include "kernels/stepping/csr.hpp"
#include "kernels/stepping/mirror.hpp"
#include "kernels/stepping/plan.hpp"
#include "kernels/stepping/ring.hpp"
#include "kernels/stepping/rings.hpp"
#include "kernels/stepping/strict.hpp"

namespace bounce {

std::span<const KernelEntry> kernels() {
  static const std::vector<KernelEntry> entries{mirror_entry(), ring_entry(), rings_entry(),
                                                csr_entry(), strict_entry()};
  return entries;
}

}  // namespace bounce
