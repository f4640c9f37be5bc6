#include "verify/watch/margin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

// Lanczos takes some milliseconds on the paper's ball and about a second on the largest that it is
// used for (lanczos_particles).
std::size_t looks_to_keep(std::size_t particles) {
  constexpr std::size_t most = 8;
  return std::clamp<std::size_t>(most * small_ball / std::max<std::size_t>(particles, 1), 1, most);
}

}  // namespace

double part_of_stable_step(const Problem& problem, double omega) {
  return problem.step * omega / stability_limit(*problem.method);
}

MarginGauge::MarginGauge(const Problem& problem)
    : problem_(&problem),
      limit_(stability_limit(*problem.method)),
      room_(looks_to_keep(problem.bonds.particles())) {}

double MarginGauge::add(std::int64_t step, const State& state) {
  const auto bound = stiffness_bound(*problem_, state);
  if (!bound) {
    dropped_ = std::numeric_limits<double>::infinity();
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double part = problem_->step * std::sqrt(bound->lambda) / limit_;
  if (worst_.size() == room_ && !(part > worst_.back().part)) {
    dropped_ = std::max(dropped_, part);
  } else {
    keep({part, step, *bound, {}}, state);
  }
  return part;
}

void MarginGauge::keep(Look look, const State& state) {
  if (worst_.size() == room_) {
    dropped_ = std::max(dropped_, worst_.back().part);
    worst_.pop_back();
  }
  if (state.size() <= lanczos_particles) look.state = state;
  const auto at =
      std::upper_bound(worst_.begin(), worst_.end(), look.part,
                       [](double part, const Look& other) { return part > other.part; });
  worst_.insert(at, std::move(look));
}

std::optional<Margin> MarginGauge::result() const {
  if (worst_.empty()) return std::nullopt;
  Margin margin;
  for (const Look& look : worst_) {
    if (margin.exact && look.part <= margin.part) break;  // nor can any after it be worse
    Margin here{look.part,        look.part,         false,           look.step,
                look.bound.first, look.bound.second, look.bound.ratio};
    if (look.state.size() > 0) {
      if (const auto found = fastest_vibration(*problem_, look.state); found && found->exact) {
        here.part = problem_->step * found->omega / limit_;
        here.exact = true;
      }
    }
    if (&look == &worst_.front() || here.part > margin.part) margin = here;
    if (!here.exact) break;  // parts by the bound fall from here on
  }
  margin.at_most = std::max(margin.part, dropped_);
  return margin;
}

}  // namespace bounce
