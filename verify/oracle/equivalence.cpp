#include "verify/oracle/equivalence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "kernels/plan/plan.hpp"
#include "verify/figures/bounce_gauge.hpp"
#include "verify/oracle/oracle.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {
namespace {

constexpr std::int64_t single_steps = 1000;    // compared one by one, then by the chunk
constexpr std::int64_t chunk = 1000;           // steps
constexpr std::int64_t sample_every = 10000;   // steps between two samples of the observables
constexpr double disturbances_allowed = 10.0;  // see the head of equivalence.hpp
constexpr std::uint32_t disturbed_copies = 6;
constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr std::array<const char*, 4> array_names{"x", "y", "vx", "vy"};

const std::vector<double>& array_of(const State& state, std::size_t which) {
  const std::array<const std::vector<double>*, 4> arrays{&state.x, &state.y, &state.vx, &state.vy};
  return *arrays[which];
}

bool same_bits(const State& a, const State& b) { return state_hash(a) == state_hash(b); }

// fmax would drop a NaN.
void raise_to(double& largest, double value) {
  if (!(value <= largest)) largest = std::isnan(value) ? infinity : value;
}

// False for a NaN, and where the disturbed balls themselves have blown up and would allow anything.
bool holds(double measured, double allowed) {
  return std::isfinite(allowed) && measured <= allowed;
}

double position_difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    raise_to(largest, std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]));
  }
  return largest;
}

std::string print(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2e", value);
  return text.data();
}

std::string print_steps(std::int64_t steps) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", static_cast<double>(steps));
  return text.data();
}

// One ULP up or down at every coordinate, by the fixed sequence that starts from `random`.
State disturbed(State state, std::uint32_t random) {
  const auto direction = [&random] {
    random = random * 1664525U + 1013904223U;  // Numerical Recipes' generator
    return (random >> 31U) != 0 ? infinity : -infinity;
  };
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.x[i] = std::nextafter(state.x[i], direction());
    state.y[i] = std::nextafter(state.y[i], direction());
  }
  return state;
}

// Rounding of one kick: a sum of at most six forces, each of a few operations on terms of this
// size.
double kick_rounding(const Problem& problem) {
  double largest = 0.0;
  const BondList& bonds = problem.bonds;
  const State& at = problem.initial;
  for (std::size_t i = 0; i < at.size(); ++i) {
    double sum = 0.0;
    for (std::int64_t e = bonds.start[i]; e < bonds.start[i + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      const auto j = static_cast<std::size_t>(bonds.neighbour[entry]);
      const double r = std::hypot(at.x[i] - at.x[j], at.y[i] - at.y[j]);
      const BondClass& bond = problem.classes[bonds.bond_class[entry]];
      sum += bond.attraction / std::pow(r, problem.law.p);
      sum += bond.repulsion / std::pow(r, problem.law.q);
    }
    largest = std::max(largest, sum);
  }
  constexpr double operations =
      16.0;  // roundings from R^2 to the sum, each of half an epsilon, twice
  return operations * std::numeric_limits<double>::epsilon() * problem.step * largest;
}

// What is compared on whole runs.
struct Observables {
  static constexpr std::size_t count = 9;
  static constexpr std::size_t total_energy = 4, contact_time = 7, energy_lost = 8;
  static constexpr std::array<const char*, count> names{
      "centre's height", "kinetic energy", "bond energy",  "gravity energy", "total energy",
      "lowest centre",   "rebound height", "contact time", "energy lost"};
  std::array<double, count> values{};
};

Observables observe(const Sample& sample, const Bounce& bounce, double start_energy) {
  return {{sample.centre.y, sample.kinetic, sample.bond, sample.gravity, sample.total(),
           bounce.lowest_centre->value, bounce.rebound_height->value, bounce.contact_time->value,
           start_energy - sample.total()}};
}

// A run beside the oracle's, and how far it has been off.
struct Runner {
  std::unique_ptr<Stepper> stepper;
  BounceGauge gauge;
  double position = 0.0;  // largest difference so far, cm
  std::array<double, Observables::count> observables{};
};

class Comparison {
 public:
  Comparison(std::string name, const Scene& scene, std::span<const KernelUnderTest> kernels)
      : name_(std::move(name)),
        scene_(scene),
        problem_(make_problem(scene)),
        oracle_(scene, problem_.initial),
        kernels_(kernels),
        last_equal_(problem_.initial) {
    for (const KernelUnderTest& kernel : kernels) {
      runners_.push_back({kernel.make(problem_), oracle_gauge_, 0.0, {}});
    }
    PlanRequest strict;
    strict.kernel = "strict";
    strict.threads = 1;
    for (std::uint32_t copy = 1; copy <= disturbed_copies; ++copy) {
      disturbed_.push_back({make_stepper(problem_, strict), oracle_gauge_, 0.0, {}});
      disturbed_.back().stepper->restore({disturbed(problem_.initial, copy), false, 0});
    }
    first_.resize(kernels.size());
  }

  std::vector<EquivalenceRow> run(std::int64_t steps, bool observables,
                                  const EquivalenceProgress& progress) {
    std::int64_t next_decade = 1000;
    std::vector<EquivalenceRow> decades;
    while (at_ < steps) {
      const std::int64_t boundary = (at_ / chunk + 1) * chunk;
      const std::int64_t next = at_ < single_steps ? at_ + 1 : boundary;
      advance_to(std::min(next, steps));
      if (observables && at_ % sample_every == 0) sample();
      if (at_ == next_decade) {
        for (std::size_t k = 0; k < runners_.size(); ++k) add_position_row(k, decades);
        next_decade *= 10;
      }
      if (progress && at_ % chunk == 0) progress(at_);
    }
    std::vector<EquivalenceRow> rows;
    for (std::size_t k = 0; k < runners_.size(); ++k) {
      add_bits_row(k, rows);
      for (const EquivalenceRow& row : decades) {
        if (row.kernel == kernels_[k].name) rows.push_back(row);
      }
      if (kernels_[k].same_bits) continue;
      if (at_ * 10 != next_decade) add_position_row(k, rows);
      if (observables) add_observable_rows(k, rows);
    }
    return rows;
  }

 private:
  struct Difference {
    std::int64_t step = 0;
    std::size_t particle = 0;
    std::size_t array = 0;
    double ulps = 0.0;
    double velocity = 0.0;  // largest difference of a velocity, cm/s
    double position = 0.0;  // largest difference of a coordinate, cm
  };

  void advance_to(std::int64_t step) {
    const std::int64_t steps = step - at_;
    oracle_.step(steps);
    now_ = oracle_.state();
    at_ = step;
    for (Runner& copy : disturbed_) {
      copy.stepper->advance(steps);
      raise_to(copy.position, position_difference(copy.stepper->state(), now_));
    }
    for (std::size_t k = 0; k < runners_.size(); ++k) {
      runners_[k].stepper->advance(steps);
      const State state = runners_[k].stepper->state();
      raise_to(runners_[k].position, position_difference(state, now_));
      if (!first_[k] && !same_bits(state, now_)) first_[k] = find_difference(k, step - steps);
    }
    last_equal_ = now_;
  }

  // The first differing step after `from`, at which all bits were the oracle's still.
  Difference find_difference(std::size_t k, std::int64_t from) {
    Oracle oracle(scene_, last_equal_);
    auto again = kernels_[k].make(problem_);
    again->restore({last_equal_, false, from});
    for (std::int64_t step = from + 1;; ++step) {
      oracle.step(1);
      again->advance(1);
      const State theirs = again->state();
      const State ours = oracle.state();
      // At the end of the chunk they differ, or this re-run is not the same as the run was.
      if (!same_bits(theirs, ours) || step >= at_) return compare(step, theirs, ours);
    }
  }

  static Difference compare(std::int64_t step, const State& theirs, const State& ours) {
    Difference found{.step = step};
    for (std::size_t which = 0; which < array_names.size(); ++which) {
      for (std::size_t i = 0; i < ours.size(); ++i) {
        const double a = array_of(theirs, which)[i];
        const double b = array_of(ours, which)[i];
        const double ulps = ulps_between(a, b);
        if (ulps == 0.0) continue;
        if (which < 2) {
          raise_to(found.position, std::abs(a - b));
        } else {
          raise_to(found.velocity, std::abs(a - b));
        }
        if (found.ulps == 0.0) {
          found.particle = i;
          found.array = which;
          found.ulps = ulps;
        }
      }
    }
    return found;
  }

  void sample() {
    const Observables ours = look(now_, oracle_gauge_);
    for (std::size_t i = 0; i < Observables::count; ++i) {
      raise_to(largest_[i], std::abs(ours.values[i]));
    }
    for (Runner& copy : disturbed_) compare_observables(copy, ours);
    for (Runner& runner : runners_) compare_observables(runner, ours);
  }

  // Looks alone: going back would take longer than the run.
  Observables look(const State& state, BounceGauge& gauge) const {
    gauge.look(at_, state);
    return observe(measure(problem_, state), gauge.result(), start_energy_);
  }

  void compare_observables(Runner& runner, const Observables& ours) const {
    if (!is_finite(runner.stepper->state())) {
      runner.observables.fill(infinity);
      return;
    }
    const Observables theirs = look(runner.stepper->state(), runner.gauge);
    for (std::size_t i = 0; i < Observables::count; ++i) {
      raise_to(runner.observables[i], std::abs(theirs.values[i] - ours.values[i]));
    }
  }

  void add_row(std::size_t k, std::string check, std::string measured, std::string allowed,
               bool pass, std::vector<EquivalenceRow>& rows) const {
    rows.push_back(
        {name_, kernels_[k].name, std::move(check), std::move(measured), std::move(allowed), pass});
  }

  void add_bits_row(std::size_t k, std::vector<EquivalenceRow>& rows) const {
    const std::optional<Difference>& d = first_[k];
    const std::string none = "none in " + print_steps(at_) + " steps";
    std::string measured = none;
    if (d) {
      measured = "step " + std::to_string(d->step) + ", " + array_names[d->array] +
                 " of particle " + std::to_string(d->particle + 1) + ", " + print(d->ulps) + " ULP";
    }
    if (kernels_[k].same_bits) {
      add_row(k, "first differing bit", measured, none, !d.has_value(), rows);
      return;
    }
    add_row(k, "first differing bit", measured, "reported", true, rows);
    if (!d) return;
    // Besides the kick's own rounding: sums that go onto the velocity round at its size, six times.
    const double rounding =
        kick_rounding(problem_) + 8.0 * std::numeric_limits<double>::epsilon() * largest_speed();
    add_row(k, "  velocity there, cm/s", print(d->velocity), print(rounding),
            holds(d->velocity, rounding), rows);
    // A coordinate may come to lie on the other side of a rounding, and the kick's shows in it.
    const double last_place = largest_coordinate() * std::numeric_limits<double>::epsilon();
    const double allowed = last_place + problem_.step * rounding;
    add_row(k, "  position there, cm", print(d->position), print(allowed),
            holds(d->position, allowed), rows);
  }

  static double largest_of(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0.0;
    for (const double v : a) largest = std::max(largest, std::abs(v));
    for (const double v : b) largest = std::max(largest, std::abs(v));
    return largest;
  }
  [[nodiscard]] double largest_coordinate() const {
    return largest_of(problem_.initial.x, problem_.initial.y);
  }
  [[nodiscard]] double largest_speed() const {
    return largest_of(problem_.initial.vx, problem_.initial.vy);
  }

  void add_position_row(std::size_t k, std::vector<EquivalenceRow>& rows) const {
    const double measured = runners_[k].position;
    double allowed = 0.0;
    for (const Runner& copy : disturbed_) {
      allowed = std::max(allowed, disturbances_allowed * copy.position);
    }
    if (kernels_[k].same_bits) return;
    add_row(k, "position after " + print_steps(at_) + " steps, cm", print(measured), print(allowed),
            holds(measured, allowed), rows);
  }

  void add_observable_rows(std::size_t k, std::vector<EquivalenceRow>& rows) const {
    for (std::size_t i = 0; i < Observables::count; ++i) {
      const double measured = runners_[k].observables[i];
      double allowed = finest_difference(i);
      for (const Runner& copy : disturbed_) {
        allowed = std::max(allowed, disturbances_allowed * copy.observables[i]);
      }
      add_row(k, Observables::names[i], print(measured), print(allowed), holds(measured, allowed),
              rows);
    }
  }

  // Below this an observable says nothing: the last places of its sums, of the total energy for the
  // energy lost; for the contact time, whose ends lie between two samples, twice that.
  [[nodiscard]] double finest_difference(std::size_t i) const {
    constexpr double last_places = 16.0 * std::numeric_limits<double>::epsilon();
    if (i == Observables::contact_time) {
      return 2.0 * static_cast<double>(sample_every) * problem_.step * (1.0 + last_places);
    }
    return last_places * largest_[i == Observables::energy_lost ? Observables::total_energy : i];
  }

  std::string name_;
  Scene scene_;
  Problem problem_;
  Oracle oracle_;
  std::span<const KernelUnderTest> kernels_;
  std::vector<Runner> runners_;
  std::vector<std::optional<Difference>> first_;
  std::vector<Runner> disturbed_;
  BounceGauge oracle_gauge_{problem_, problem_.step, {}};
  double start_energy_ = measure(problem_, problem_.initial).total();
  std::array<double, Observables::count> largest_{};
  State now_;
  State last_equal_;
  std::int64_t at_ = 0;
};

}  // namespace

double ulps_between(double a, double b) {
  if (!(std::isfinite(a) && std::isfinite(b))) return infinity;
  if (a == b) return 0.0;
  const double larger = std::max(std::abs(a), std::abs(b));
  return std::abs(a - b) / (larger - std::nextafter(larger, 0.0));
}

std::vector<KernelUnderTest> kernels_under_test(const std::string& vector) {
  choose_vector(vector);
  std::vector<KernelUnderTest> all;
  for (const KernelEntry& entry : kernels()) {
    const PlanRequest request{entry.name, vector, 1};
    all.push_back({entry.name, entry.has_listings_bits,
                   [request](const Problem& problem) { return make_stepper(problem, request); },
                   [request](const Problem& problem) {
                     try {
                       static_cast<void>(make_plan(problem, request));
                     } catch (const PlanError&) {
                       return false;
                     }
                     return true;
                   }});
  }
  return all;
}

std::vector<EquivalenceRow> check_equivalence(const std::string& name, const Scene& scene,
                                              std::int64_t steps, bool observables,
                                              std::span<const KernelUnderTest> kernels,
                                              const EquivalenceProgress& progress) {
  const Problem problem = make_problem(scene);
  std::vector<KernelUnderTest> running;
  std::copy_if(kernels.begin(), kernels.end(), std::back_inserter(running),
               [&](const KernelUnderTest& kernel) { return !kernel.runs || kernel.runs(problem); });
  return Comparison(name, scene, running).run(steps, observables, progress);
}

Scene at_the_wall(const Scene& scene) {
  constexpr double gap = 0.005;  // cm; at 0.7 cm/s some 7000 steps of 1e-6 s
  Scene moved = scene;
  const Wall* nearest = nullptr;
  double distance = infinity;
  for (const Wall& wall : scene.walls) {
    const double d =
        wall_distance(wall, scene.ball.centre.x, scene.ball.centre.y) - scene.ball.radii.back();
    if (d < distance) {
      distance = d;
      nearest = &wall;
    }
  }
  if (nearest == nullptr || distance <= gap) return moved;
  const double fall = distance - gap;
  moved.ball.centre.x -= fall * nearest->normal.x;
  moved.ball.centre.y -= fall * nearest->normal.y;
  const double pull = -(scene.gravity.x * nearest->normal.x + scene.gravity.y * nearest->normal.y);
  const double speed = std::sqrt(2.0 * std::max(pull, 0.0) * fall);
  moved.ball.velocity.x -= speed * nearest->normal.x;
  moved.ball.velocity.y -= speed * nearest->normal.y;
  return moved;
}

}  // namespace bounce
