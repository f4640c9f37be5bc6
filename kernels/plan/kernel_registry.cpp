#include <vector>

#include "kernels/contact/located.hpp"
#include "kernels/csr/csr.hpp"
#include "kernels/csr/strict.hpp"
#include "kernels/plan/plan.hpp"
#include "kernels/rings/annulus.hpp"
#include "kernels/rings/mirror.hpp"
#include "kernels/rings/ring.hpp"

namespace bounce {

std::span<const KernelEntry> kernels() {
  static const std::vector<KernelEntry> entries{located_entry(), mirror_entry(), ring_entry(),
                                                annulus_entry(), csr_entry(),    strict_entry()};
  return entries;
}

}  // namespace bounce
