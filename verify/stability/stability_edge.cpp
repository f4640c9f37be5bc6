#include "verify/stability/stability_edge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "verify/stability/bounce_run.hpp"
#include "verify/stability/bracket.hpp"
#include "verify/stability/energy_judge.hpp"
#include "verify/stability/vibration.hpp"
#include "verify/vibrations/spectrum.hpp"
#include "verify/vibrations/stability_limit.hpp"

namespace bounce {
namespace {

constexpr double first_part = 0.25;  // of the stable step, at which a bounce is first followed
constexpr int most_follows = 3;      // each at a quarter of the step before
// The longest that a bounce is followed, in periods of the fastest vibration at rest: the paper's
// ball has come off long before, a soft one that is crushed lies for ever.
constexpr double longest_bounce = 12'000.0;
constexpr double longer = 1.25;  // than the bounce that was followed
constexpr double lowest_part = 1 / 200.0;
constexpr double highest_part = 8.0;
// The rounding of the start strains bonds, so even at rest frequencies swing by some 0.1 %, the
// part by which measured edges lie above the strict limit in results/stability.md. A vibration is
// in a window as wide as that half of its time.
constexpr double narrow_spare = 2.0;
constexpr double around_window = 1.005;        // narrow; more than rounded starts move frequencies
constexpr std::int64_t look_at_edge = 3;       // steps, about a period there
constexpr std::int64_t look_in_flight = 2000;  // steps
constexpr std::int64_t look_in_bounce = 500;   // a wall may cool what a step has heated

// By what, as a logarithm, the energy of the fastest vibration has to grow for the ball's to exceed
// `growth` times its start: at random it has one (2 N - 3)th of that.
double growth_of_fastest(const Problem& problem, double growth) {
  const double vibrations = std::max(2.0 * static_cast<double>(problem.initial.size()) - 3.0, 1.0);
  return std::log(growth * vibrations);
}

/// One case on its way to its edge.
class Measurement {
 public:
  explicit Measurement(const EdgeCase& what) : case_(&what) {
    try {
      prepare();
    } catch (const SceneError& error) {
      refuse(error.what());
    }
  }
  [[nodiscard]] bool refused() const { return !edge_.why.empty(); }
  [[nodiscard]] bool done() const { return refused() || bracket_->done(); }

  // The bounce at a part of the stable step of flight, to be followed.
  [[nodiscard]] bool to_be_followed() const {
    return !refused() && case_->passage == Passage::bounce && !followed_ && follows_ < most_follows;
  }
  [[nodiscard]] Problem problem_to_follow() const {
    return at_part(first_part * std::pow(0.25, follows_));
  }
  // About once in a period of the fastest vibration; for all cases of a method the same.
  [[nodiscard]] std::int64_t look_every() const {
    const double z = stability_limit(*start_.method) * first_part * std::pow(0.25, follows_);
    return std::max<std::int64_t>(1, std::llround(2.0 * std::numbers::pi / z));
  }
  [[nodiscard]] double omega_of(const Problem& problem) const {
    // omega^2 goes with E.
    return omega_ * std::sqrt(problem.classes[0].attraction / start_.classes[0].attraction);
  }
  void take(const BounceRun& bounce, const Problem& problem) {
    ++follows_;
    if (!bounce.stable || !bounce.margin) return;
    followed_ = true;
    followed_end_ = bounce.end;
    followed_omega_ = omega_of(problem);
    edge_.left = bounce.left;
    edge_.ratio = bounce.margin->ratio;
    // Part of the stable step used -> the step, or E, that would have used all of it.
    const double part = bounce.margin->part;
    edge_.strict = case_->sought == Sought::step ? problem.step / part
                                                 : elasticity_of(problem) / (part * part);
    edge_.predicted = edge_.strict * edge_.flight / strict_flight_;
  }
  // Once the bounce has been followed, or at once in flight.
  void begin() {
    if (!refused()) search_next();
  }

  [[nodiscard]] Problem next_problem() const { return at_value(bracket_->next()); }
  [[nodiscard]] std::int64_t steps_of(const Problem& problem) const {
    const double period = 2.0 * std::numbers::pi / omega_of(problem);
    double time = case_->criterion.periods * period;
    if (case_->passage == Passage::bounce) {
      // Contact takes a number of periods that depends little on E; the way down does not.
      const double stretch = std::max(1.0, followed_omega_ / omega_of(problem));
      time = followed_ ? longer * stretch * followed_end_ : longest_bounce * period;
    }
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(time / problem.step)));
  }
  void take(bool stable, std::int64_t steps) {
    bracket_->take(stable);
    ++edge_.runs;
    edge_.steps += steps;
    // A narrow window in which nothing grew, or below which something did.
    if (bracket_->done() && !bracket_->closed() && in_narrow_) search_next();
  }
  // The bounce at the edge itself: does the running margin see it coming?
  [[nodiscard]] bool has_edge_to_follow() const {
    return done() && !refused() && case_->passage == Passage::bounce && bracket_->stable() > 0.0;
  }
  [[nodiscard]] Problem edge_problem() const { return at_value(bracket_->stable()); }
  void take_edge(const BounceRun& bounce) {
    if (bounce.margin) edge_.used = bounce.margin->part;
  }
  [[nodiscard]] const EdgeCase& what() const { return *case_; }

  [[nodiscard]] Edge result() const {
    Edge edge = edge_;
    if (refused()) return edge;
    edge.stable = bracket_->stable();
    edge.unstable = bracket_->unstable();
    edge.outcome = bracket_->closed()             ? EdgeOutcome::found
                   : std::isfinite(edge.unstable) ? EdgeOutcome::always_unstable
                                                  : EdgeOutcome::always_stable;
    return edge;
  }

 private:
  void refuse(const std::string& why) {
    edge_.outcome = EdgeOutcome::refused;
    edge_.why = why;
  }

  void prepare() {
    start_ = made(case_->scene);
    const auto fastest = fastest_vibration(start_, start_.initial);
    if (!fastest) return refuse("a bond has no finite stiffness");
    if (!(fastest->omega > 0.0)) return refuse("nothing vibrates");
    omega_ = fastest->omega;
    strict_flight_ = value_of(stability_limit(*start_.method));
    find_windows();
    edge_.flight = value_of(windows_.front().edge);
    if (case_->passage == Passage::flight) {
      edge_.predicted = edge_.flight;
      edge_.strict = strict_flight_;
    }
  }

  // Neither pressed nor vibrating visibly: else no vibration stays in a narrow window.
  [[nodiscard]] bool keeps_frequencies() const {
    return case_->passage == Passage::flight && case_->disturbance == edge_disturbance;
  }

  // z of the fastest vibration at rest -> the step, or E, that has it.
  [[nodiscard]] double value_of(double z) const {
    const double part = start_.step * omega_ / z;
    return case_->sought == Sought::step ? z / omega_ : case_->scene.law.elasticity / (part * part);
  }

  // The windows that exceed the criterion, up to the first that cannot be stepped over.
  void find_windows() {
    const auto stages = start_.method->stages;
    const double wanted =
        growth_of_fastest(start_, case_->criterion.growth) / case_->criterion.periods;
    for (const UnstableWindow& window : unstable_windows(stages)) {
      const bool narrow = window.to < narrow_window * window.from;
      if (narrow && !keeps_frequencies()) continue;
      const double spare = narrow ? narrow_spare : 1.0;
      if (const auto edge = first_growing(stages, window, spare * wanted)) {
        windows_.push_back({*edge, window, narrow});
        if (!narrow) return;
      }
    }
    // By so lax a criterion no step is unstable: the limit is where to begin.
    const double limit = stability_limit(*start_.method);
    if (windows_.empty()) windows_.push_back({limit, {limit, limit, limit, 0.0}, false});
  }

  // Begins the search in the next window.
  void search_next() {
    const double power = case_->sought == Sought::step ? 1.0 : 2.0;
    const Window& window = windows_[std::min(next_window_, windows_.size() - 1)];
    in_narrow_ = window.narrow && next_window_ < windows_.size();
    ++next_window_;
    if (in_narrow_) {
      // In steps of half its width, from as far below as frequencies at the start may be off.
      const double lowest = value_of(window.at.from / around_window);
      const double highest = value_of(window.at.to * around_window);
      const double step = std::pow(window.at.to / window.at.from, 0.5 * power);
      bracket_.emplace(lowest, step, power, lowest, highest, true);
      return;
    }
    const bool climb = case_->disturbance != edge_disturbance;
    const double lowest = std::pow(lowest_part, power) * edge_.flight;
    const double highest = std::pow(highest_part, power) * edge_.flight;
    double from = climb ? edge_.strict : value_of(window.edge);
    if (case_->passage == Passage::bounce) from = edge_.predicted > 0.0 ? edge_.predicted : lowest;
    bracket_.emplace(from, edge_ratio, power, lowest, highest, climb);
  }

  // The scene ready to run, at its own step and E.
  Problem made(const Scene& scene) {
    Problem problem = make_problem(scene, case_->initial);
    if (case_->passage == Passage::flight) {
      problem.walls.clear();
      problem.gravity = {};
      const Vec2 mean = mean_velocity(problem.initial);
      push(problem.initial, {-mean.x, -mean.y});
    } else {
      edge_.speed = case_->speed > 0.0 ? case_->speed : meeting_speed(problem);
      if (!(edge_.speed > 0.0)) {
        throw SceneError("wall", "none that the ball comes to", "a wall below it, or a speed");
      }
      problem.initial = just_above_wall(problem, edge_.speed);
    }
    disturb(problem.initial, case_->disturbance * shortest_rest(problem));
    return problem;
  }

  [[nodiscard]] double elasticity_of(const Problem& problem) const {
    return case_->scene.law.elasticity * problem.classes[0].attraction /
           start_.classes[0].attraction;
  }
  // With another E every constant of every bond changes by the same factor. Not rounded again: the
  // rounding to single precision is 1e-7 of it, the bracket's width 1e-2.
  [[nodiscard]] Problem at_value(double value) const {
    Problem problem = start_;
    if (case_->sought == Sought::step) {
      problem.step = value;
      return problem;
    }
    const double factor = value / case_->scene.law.elasticity;
    for (BondClass& bond : problem.classes) {
      bond.attraction *= factor;
      bond.repulsion *= factor;
    }
    return problem;
  }
  // At a part of the stable step of flight: by the step, or by E, which goes with its square.
  [[nodiscard]] Problem at_part(double part) const {
    return at_value(edge_.flight * (case_->sought == Sought::step ? part : part * part));
  }

  struct Window {
    double edge;  // z at which the criterion is exceeded
    UnstableWindow at;
    bool narrow;
  };

  const EdgeCase* case_;
  Problem start_;
  std::vector<Window> windows_;
  std::size_t next_window_ = 0;
  bool in_narrow_ = false;  // the search climbs through a narrow window
  double strict_flight_ = 0.0;
  double omega_ = 0.0;  // 1/s, at the start with the scene's E
  bool followed_ = false;
  int follows_ = 0;
  double followed_end_ = 0.0;    // s
  double followed_omega_ = 0.0;  // with the E that was followed
  std::optional<Bracket> bracket_;
  Edge edge_;
};

using Measurements = std::vector<Measurement>;

bool stopped(const TrialOptions& options) { return options.stop && options.stop(); }

// Bounces to be followed side by side.
struct Following {
  std::vector<Measurement*> cases;
  std::vector<Problem> problems;
  std::vector<std::int64_t> steps;
  std::vector<double> growth;

  void add(Measurement& which, Problem problem) {
    cases.push_back(&which);
    steps.push_back(which.steps_of(problem));
    growth.push_back(which.what().criterion.growth);
    problems.push_back(std::move(problem));
  }
  [[nodiscard]] std::vector<BounceRun> run(std::int64_t look_every,
                                           const TrialOptions& options) const {
    return follow_bounces(problems, steps, look_every, growth, options);
  }
};

// Follows the bounces of those cases that need it, at smaller steps where that was unstable.
void follow(Measurements& all, const TrialOptions& options) {
  for (;;) {
    Following now;
    for (Measurement& each : all) {
      if (each.to_be_followed()) now.add(each, each.problem_to_follow());
    }
    if (now.cases.empty() || stopped(options)) return;
    const auto bounces = now.run(now.cases.front()->look_every(), options);
    for (std::size_t i = 0; i < bounces.size(); ++i)
      now.cases[i]->take(bounces[i], now.problems[i]);
  }
}

// Follows each bounce once more at its edge.
void follow_edges(Measurements& all, const TrialOptions& options) {
  Following now;
  for (Measurement& each : all) {
    if (each.has_edge_to_follow()) now.add(each, each.edge_problem());
  }
  if (now.cases.empty() || stopped(options)) return;
  const auto bounces = now.run(look_at_edge, options);
  for (std::size_t i = 0; i < bounces.size(); ++i) now.cases[i]->take_edge(bounces[i]);
}

// One run of each case whose passage this is and whose bracket is open. False if there was none.
bool run_round(Measurements& all, Passage passage, const TrialOptions& options) {
  std::vector<Measurement*> active;
  std::vector<Problem> problems;
  std::vector<std::int64_t> steps;
  for (Measurement& each : all) {
    if (each.done() || each.what().passage != passage) continue;
    active.push_back(&each);
    problems.push_back(each.next_problem());
    steps.push_back(each.steps_of(problems.back()));
  }
  if (active.empty()) return false;
  std::vector<EnergyJudge> judges;
  for (std::size_t i = 0; i < active.size(); ++i) {
    judges.emplace_back(problems[i], active[i]->what().criterion.growth);
  }
  const auto look = passage == Passage::flight ? look_in_flight : look_in_bounce;
  const std::vector<bool> good = run_trials(
      problems, steps, look,
      [&](std::size_t i, const State& state) { return judges[i].is_good(state); }, options);
  if (stopped(options)) return false;
  for (std::size_t i = 0; i < active.size(); ++i) active[i]->take(good[i], steps[i]);
  return true;
}

}  // namespace

double periods_for_strict_limit(const Scene& scene, const std::optional<State>& initial,
                                double growth) {
  const Problem problem = make_problem(scene, initial);
  const auto windows = unstable_windows(problem.method->stages);
  if (windows.empty()) return std::numeric_limits<double>::infinity();
  return narrow_spare * growth_of_fastest(problem, growth) / windows.front().growth;
}

std::optional<std::vector<Edge>> measure_edges(std::span<const EdgeCase> cases,
                                               const TrialOptions& options) {
  Measurements all(cases.begin(), cases.end());
  follow(all, options);
  for (Measurement& each : all) each.begin();
  for (const Passage passage : {Passage::flight, Passage::bounce}) {
    while (run_round(all, passage, options)) {
    }
  }
  follow_edges(all, options);
  if (stopped(options)) return std::nullopt;
  std::vector<Edge> edges;
  for (const Measurement& each : all) edges.push_back(each.result());
  return edges;
}

}  // namespace bounce
