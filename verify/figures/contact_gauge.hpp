// The figures of a bounce (bounce.hpp) of a solution that knows its contacts: every step of it is
// looked at, and looked at again where an extreme may lie within it. Its acts are its events.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "kernels/contact/contact_run.hpp"
#include "verify/figures/bounce.hpp"

namespace bounce {

class ContactGauge final : public ContactWatch {
 public:
  /// The problem has to outlive it. `again`: whether steps may be made anew (a solver of many steps'
  /// memory begins afresh then).
  explicit ContactGauge(const Problem& problem, bool again = true);

  void begin(double time, const State& state) override;
  void step(double time, const State& end, const std::function<State(double)>& again) override;
  void contact(const ContactEvent& event) override;

  /// Up to the last step; energies are not seen.
  [[nodiscard]] Bounce result() const;

 private:
  struct WallCourse {
    std::size_t held = 0;  // particles
    std::optional<Impact> impact;
    bool acted = false;  // since the last step
  };

  const Problem* problem_;
  bool again_;
  double least_flight_;
  double time_ = 0.0;
  Vec2 velocity_;
  std::vector<WallCourse> walls_;
  std::vector<Impact> over_;
  Extremes extremes_;
};

}  // namespace bounce
