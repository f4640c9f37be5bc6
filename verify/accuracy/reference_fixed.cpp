// Solution two: Blanes and Moan's SRKN_11^b in x87's long double (64 bits of significand), fixed
// steps, cut at contacts.
//
// Long double rather than compensated double: a ball's forces are small differences of large
// numbers (a bond of 0.26 cm at E = 16000 turns the 1e-15 cm by which a coordinate is rounded into
// 1e-8 cm/s^2), so what needs the digits are the positions within the forces, which a compensated
// sum of positions alone does not give them. With 5e-19 cm left of 1e-15 cm a compensated sum on
// top changes nothing that double precision output shows. Times do not add up: an interval between
// two output times, or from a contact to the next one, is divided into equal steps.
#include <array>
#include <cmath>

#include "kernels/contact/contact_solver.hpp"
#include "verify/accuracy/reference_solution.hpp"

namespace bounce {
namespace {

using Long = long double;
static_assert(std::numeric_limits<Long>::digits >= 64,
              "long double is no wider than double here: solution two needs x87's");

// Blanes, Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3, SRKN_11^b: kicks b1 ... b6 b6 ...
// b1, drifts a1 ... a6 ... a1 between them. Printed to 15 digits; the last of each follows from the
// sums.
struct Composition {
  std::array<Long, 12> kick{};
  std::array<Long, 11> drift{};
};
constexpr Composition make_composition() {
  constexpr std::array<Long, 5> b{0.0414649985182624L, 0.198128671918067L, -0.0400061921041533L,
                                  0.0752539843015807L, -0.0115113874206879L};
  constexpr std::array<Long, 5> a{0.123229775946271L, 0.290553797799558L, -0.127049212625417L,
                                  -0.246331761062075L, 0.357208872795928L};
  Composition table;
  Long kicks = 0, drifts = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    table.kick[k] = table.kick[11 - k] = b[k];
    table.drift[k] = table.drift[10 - k] = a[k];
    kicks += b[k];
    drifts += a[k];
  }
  table.kick[5] = table.kick[6] = 0.5L - kicks;
  table.drift[5] = 1 - 2 * drifts;
  return table;
}
constexpr Composition composition = make_composition();

class FixedFlow {
 public:
  using Real = Long;

  FixedFlow(const Problem& problem, double step)
      : forces_(problem),
        step_(step),
        end_(4 * problem.initial.size()),
        start_pull_(2 * problem.initial.size()),
        end_pull_(2 * problem.initial.size()) {}

  [[nodiscard]] const BondForces<Long>& forces() const { return forces_; }
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  [[nodiscard]] const std::vector<Long>& start() const { return start_; }
  [[nodiscard]] const std::vector<Long>& end() const { return end_; }

  void begin(const std::vector<Long>& state, const Resting& resting) {
    start_ = state;
    resting_ = &resting;
    evaluate(start_, start_pull_);
  }

  Long attempt(Long left) {
    // The part in a million is there so that roundings of `left` do not make a step more.
    const Long steps = std::ceil(left / step_ - 1e-6L);
    const Long h = steps > 1 ? left / steps : left;
    retake(h);
    return h;
  }

  void retake(Long h) {
    end_ = start_;
    end_pull_ = start_pull_;
    const std::size_t half = end_.size() / 2;
    for (std::size_t stage = 0; stage < composition.kick.size(); ++stage) {
      if (stage > 0) {
        const Long drift = composition.drift[stage - 1] * h;
        for (std::size_t k = 0; k < half; ++k) end_[k] += drift * end_[half + k];
        evaluate(end_, end_pull_);
      }
      const Long kick = composition.kick[stage] * h;
      for (std::size_t k = 0; k < half; ++k) end_[half + k] += kick * end_pull_[k];
    }
  }

  void accept() {
    start_.swap(end_);
    start_pull_.swap(end_pull_);
  }

 private:
  void evaluate(const std::vector<Long>& state, std::vector<Long>& pull) {
    ++evaluations_;
    const std::size_t n = forces_.particles();
    forces_(state.data(), state.data() + n, pull.data(), pull.data() + n);
    resting_->hold(pull.data(), pull.data() + n);
  }

  BondForces<Long> forces_;
  Long step_;
  const Resting* resting_ = nullptr;
  std::vector<Long> start_, end_, start_pull_, end_pull_;  // pulls: accelerations x, then y
  std::int64_t evaluations_ = 0;
};

}  // namespace

ReferenceRun solve_fixed(const Problem& problem, std::span<const double> times,
                         const FixedSettings& settings, const ReferenceVisitor& visit,
                         ContactWatch* watch) {
  check_output_times(times);
  const double step = settings.step == 0.0 ? default_reference_step(problem) : settings.step;
  if (!(step > 0.0 && std::isfinite(step))) {
    throw std::invalid_argument("step " + std::to_string(step) + " s: allowed is above 0");
  }
  FixedFlow flow(problem, step);
  return ContactSolver<FixedFlow>(problem, flow).run(times, visit, watch);
}

}  // namespace bounce
