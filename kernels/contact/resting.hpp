// Which particles rest on a wall while a motion with contacts is solved.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "kernels/model/problem.hpp"

namespace bounce {

/// Which particles rest on a wall, and what that does to their motion.
class Resting {
 public:
  explicit Resting(const Problem& problem)
      : walls_(&problem.walls), wall_(problem.initial.size(), -1) {}
  /// Wall on which particle i rests; -1: none.
  [[nodiscard]] int wall_of(std::size_t i) const { return wall_[i]; }
  [[nodiscard]] bool slides(std::size_t i) const { return on(i).alpha == 1.0; }
  void put(std::size_t i, std::size_t wall) {
    wall_[i] = static_cast<int>(wall);
    particles_.push_back(i);
  }
  void release(std::size_t i) {
    wall_[i] = -1;
    particles_.erase(std::find(particles_.begin(), particles_.end(), i));
  }
  [[nodiscard]] const std::vector<std::size_t>& particles() const { return particles_; }
  void release_all() {
    while (!particles_.empty()) release(particles_.back());
  }
  /// Takes from a vector of each particle (accelerations, velocities) what its wall does not let it
  /// have: all of it if it sticks, the normal part if it slides.
  template <class Real>
  void hold(Real* x, Real* y) const {
    for (const std::size_t i : particles_) hold(i, x[i], y[i]);
  }
  /// The same for a vector of particle i alone, which must be resting.
  template <class Real>
  void hold(std::size_t i, Real& x, Real& y) const {
    const auto nx = static_cast<Real>(on(i).normal.x), ny = static_cast<Real>(on(i).normal.y);
    const Real along = slides(i) ? ny * x - nx * y : Real(0);
    x = ny * along;
    y = -nx * along;
  }

 private:
  [[nodiscard]] const Wall& on(std::size_t i) const {
    return (*walls_)[static_cast<std::size_t>(wall_[i])];
  }
  const std::vector<Wall>* walls_;
  std::vector<int> wall_;
  std::vector<std::size_t> particles_;
};

}  // namespace bounce
