#include "kernels/model/neighbours.hpp"

#include <utility>

namespace bounce {

Neighbours::Neighbours() : shared_(std::make_shared<Shared>()) {}

Neighbours::Neighbours(BondList list) : Neighbours() { shared_->list = std::move(list); }

Neighbours Neighbours::of_rings(int rings, std::int64_t per_ring) {
  Neighbours neighbours;
  neighbours.rings_ = Rings{rings, per_ring};
  return neighbours;
}

std::size_t Neighbours::particles() const {
  if (!rings_) return shared_->list.particles();
  return static_cast<std::size_t>(rings_->rings * rings_->per_ring);
}

std::size_t Neighbours::entries() const {
  if (!rings_) return shared_->list.entries();
  return ring_entries(rings_->rings, rings_->per_ring);
}

std::size_t Neighbours::row_length(std::size_t i) const {
  std::size_t length = 0;
  visit_row(i, [&length](std::size_t, std::size_t) { ++length; });
  return length;
}

const BondList& Neighbours::list() const {
  if (rings_) {
    std::call_once(shared_->once,
                   [this] { shared_->list = ring_bonds(rings_->rings, rings_->per_ring); });
  }
  return shared_->list;
}

const std::vector<Neighbours::Bond>& Neighbours::kept_bonds() const {
  std::call_once(shared_->bonds_once, [this] {
    for (std::size_t i = 0; i < particles(); ++i) {
      visit_row(i, [&](std::size_t j, std::size_t bond_class) {
        if (j < i) return;
        shared_->bonds.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                                  static_cast<std::uint32_t>(bond_class)});
      });
    }
  });
  return shared_->bonds;
}

bool Neighbours::operator==(const Neighbours& other) const {
  if (rings_ && other.rings_) return *rings_ == *other.rings_;
  return shared_ == other.shared_ || list() == other.list();
}

}  // namespace bounce
