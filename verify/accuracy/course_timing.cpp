#include "verify/accuracy/course_timing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "kernels/plan/plan.hpp"
#include "verify/oracle/oracle_stepper.hpp"
#include "verify/stability/energy_judge.hpp"

namespace bounce {
namespace {

double seconds_of(Stepper& stepper, const Snapshot& start, std::int64_t steps) {
  stepper.restore(start);
  const auto begin = std::chrono::steady_clock::now();
  stepper.advance(steps);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

constexpr double papers_step = 1e-6;  // s

// The listing's program on the scene's ball; nothing if it is not the listing's ball or law.
std::unique_ptr<Stepper> make_oracle(Scene scene, const std::optional<State>& initial) {
  scene.time.method = "listing";
  scene.time.step = papers_step;
  for (Wall& wall : scene.walls) wall.contact = Contact::listing;
  const Problem problem = make_problem(scene, initial);
  const std::vector<KernelEntry> entries = kernels_with_oracle(scene);
  try {
    return make_stepper(problem, {"oracle", "auto", 1}, entries);
  } catch (const PlanError&) {
    return nullptr;
  }
}

// Two steppers for each method and contact: in flight, and where the ball is lowest.
class Kinds {
 public:
  Kinds(const Scene& scene, const std::optional<State>& initial, const Sampling& sampling,
        std::span<const AccuracyRow> rows)
      : end_(sampling.end()) {
    for (const AccuracyRow& row : rows) {
      if (row.setting.contact == Contact::located) continue;  // WholeCourses
      if (!row.record.finite || number_of(row.setting) < kinds_.size()) continue;
      kinds_.push_back(row.setting);
      const Problem problem = problem_of(scene, initial, row.setting, sampling);
      for (const double time : {0.0, row.record.lowest_time}) {
        steppers_.push_back(make_stepper(problem, {"auto", "auto", 1}));
        steppers_.back()->advance(std::llround(time / problem.step));
      }
    }
  }
  [[nodiscard]] std::vector<Stepper*> steppers() const {
    std::vector<Stepper*> all;
    for (const auto& stepper : steppers_) all.push_back(stepper.get());
    return all;
  }
  // Of a whole course, from seconds of a step of each of the steppers.
  [[nodiscard]] double seconds_of(const AccuracyRow& row, std::span<const double> steps) const {
    const std::size_t k = number_of(row.setting);
    if (k == kinds_.size()) return std::numeric_limits<double>::quiet_NaN();
    const double share = row.record.finite ? row.record.observables.contact / end_ : 0.0;
    return static_cast<double>(row.steps) *
           ((1.0 - share) * steps[2 * k] + share * steps[2 * k + 1]);
  }

 private:
  [[nodiscard]] std::size_t number_of(const Setting& setting) const {
    const auto same = std::find_if(kinds_.begin(), kinds_.end(), [&](const Setting& kind) {
      return kind.method == setting.method && kind.contact == setting.contact;
    });
    return static_cast<std::size_t>(same - kinds_.begin());
  }
  double end_;
  std::vector<Setting> kinds_;
  std::vector<std::unique_ptr<Stepper>> steppers_;
};

// Located contact takes longer wherever a wall is near, which no observable tells, and a contact
// takes its time whatever the step: of each such method two courses are run whole, those with the
// fewest steps and with four times as many, and the rest lies on the line through them. A ball that
// has blown up is elsewhere: such a course tells nothing.
class WholeCourses {
 public:
  WholeCourses(const Scene& scene, const std::optional<State>& initial, const Sampling& sampling,
               std::span<const AccuracyRow> rows) {
    std::map<std::string, std::vector<const AccuracyRow*>> methods;
    for (const AccuracyRow& row : rows) {
      if (row.setting.contact != Contact::located || !row.record.finite) continue;
      methods[row.setting.method].push_back(&row);
    }
    for (auto& [method, found] : methods) {
      std::sort(found.begin(), found.end(),
                [](const AccuracyRow* x, const AccuracyRow* y) { return x->steps < y->steps; });
      const auto time = [&](const AccuracyRow& row) {
        return time_of(problem_of(scene, initial, row.setting, sampling), row.steps);
      };
      if (const auto line = line_of(found, time)) lines_[method] = *line;
    }
  }
  [[nodiscard]] double seconds(const AccuracyRow& row) const {
    const auto found = lines_.find(row.setting.method);
    if (found == lines_.end()) return std::numeric_limits<double>::quiet_NaN();
    return found->second.once + found->second.a_step * static_cast<double>(row.steps);
  }

 private:
  struct Line {
    double once = 0.0, a_step = 0.0;  // s
  };

  // Of courses by their number of steps, each with its time or, if it has blown up, nothing.
  template <class Time>
  static std::optional<Line> line_of(std::span<const AccuracyRow* const> found, const Time& time) {
    std::optional<double> seconds;
    while (!found.empty() && !(seconds = time(*found.front()))) found = found.subspan(1);
    if (!seconds) return std::nullopt;
    const std::int64_t few = found.front()->steps;
    const auto apart = std::find_if(found.begin(), found.end(),
                                    [&](const AccuracyRow* row) { return row->steps >= 4 * few; });
    const AccuracyRow& many = apart == found.end() ? *found.back() : **apart;
    const auto steps = static_cast<double>(few);
    const auto more = many.steps > few ? time(many) : std::nullopt;
    if (!more) return Line{0.0, *seconds / steps};
    const double a_step = (*more - *seconds) / static_cast<double>(many.steps - few);
    // A negative part would be noise.
    if (!(a_step > 0.0 && *seconds > a_step * steps)) return Line{0.0, *seconds / steps};
    return Line{*seconds - a_step * steps, a_step};
  }

  static std::optional<double> time_of(const Problem& problem, std::int64_t steps) {
    constexpr std::size_t turns = 3;
    constexpr double blown_up = 100.0;  // times its energy, as for bounce stability
    const auto stepper = make_stepper(problem, {"auto", "auto", 1});
    const Snapshot start = stepper->save();
    std::vector<double> times(turns);
    for (double& time : times) {
      time = seconds_of(*stepper, start, steps);
      if (!EnergyJudge(problem, blown_up).is_good(stepper->state())) return std::nullopt;
    }
    std::sort(times.begin(), times.end());
    return times[turns / 2];
  }

  std::map<std::string, Line> lines_;  // by method
};

}  // namespace

std::vector<double> time_steps(std::span<Stepper* const> steppers, int turns, double slice) {
  std::vector<Snapshot> starts;
  std::vector<std::int64_t> steps;
  for (Stepper* const stepper : steppers) {
    starts.push_back(stepper->save());
    std::int64_t count = 16;
    while (seconds_of(*stepper, starts.back(), count) < slice) count *= 2;
    steps.push_back(count);
  }
  std::vector<std::vector<double>> times(steppers.size());
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < steppers.size(); ++i) {
      const double seconds = seconds_of(*steppers[i], starts[i], steps[i]);
      times[i].push_back(seconds / static_cast<double>(steps[i]));
    }
  }
  std::vector<double> medians;
  for (std::size_t i = 0; i < steppers.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    medians.push_back(times[i][times[i].size() / 2]);
    steppers[i]->restore(starts[i]);
  }
  return medians;
}

CourseTimes time_courses(const Scene& scene, const std::optional<State>& initial,
                         const Sampling& sampling, std::span<const AccuracyRow> rows,
                         bool with_oracle, int turns) {
  const Kinds kinds(scene, initial, sampling, rows);
  std::vector<Stepper*> steppers = kinds.steppers();
  const std::unique_ptr<Stepper> oracle = with_oracle ? make_oracle(scene, initial) : nullptr;
  if (oracle) steppers.push_back(oracle.get());
  const std::vector<double> steps = time_steps(steppers, turns);
  CourseTimes times;
  const WholeCourses whole(scene, initial, sampling, rows);
  for (const AccuracyRow& row : rows) {
    times.rows.push_back(row.setting.contact == Contact::located ? whole.seconds(row)
                                                                 : kinds.seconds_of(row, steps));
  }
  if (oracle) times.oracle = steps.back();
  return times;
}

}  // namespace bounce
