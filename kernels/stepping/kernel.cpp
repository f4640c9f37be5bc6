#include "kernels/stepping/kernel.hpp"

#include <algorithm>

namespace bounce {

bool KernelEntry::has_contacts_of(const std::vector<Wall>& walls) const {
  if (walls.empty()) return !wraps;
  return std::all_of(walls.begin(), walls.end(), [this](const Wall& wall) {
    return std::find(contacts.begin(), contacts.end(), wall.contact) != contacts.end();
  });
}

}  // namespace bounce
