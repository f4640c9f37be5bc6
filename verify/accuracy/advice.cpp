#include "verify/accuracy/advice.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/model/method.hpp"
#include "verify/accuracy/course_timing.hpp"
#include "verify/accuracy/reference_pair.hpp"

namespace bounce {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double looks = 0.01;        // s between two looks at a course
constexpr double largest_part = 0.9;  // of the stable step at the start, as an impact is stiffer
// Neighbours differ by a third: errors by a factor 2 or so. Where contacts are located, errors fall
// so fast with the step that half as many do.
constexpr int per_decade = 8;
constexpr int per_decade_located = 4;
constexpr double first_decades = 1.0;  // of steps
constexpr double finer = 3.0;          // from one round to the next
constexpr int most_rounds = 3;
constexpr double pilot_part = 1.0 / 12.0;    // of the stable step, for the pilot's reference
constexpr double least_disturbance = 1e-12;  // cm; a coordinate's rounding is 1e-15, of each step
// An error is told apart from what the pilot knows if it is that much larger.
constexpr double margin = 3.0;

double error_of(const CourseErrors& errors, const std::string& observable) {
  for (const ObservableName& each : observable_names) {
    if (each.name == observable) return errors.observables.*each.value;
  }
  return errors.position;
}

// The best comes last: the pilot's own courses have it. Without a wall the rule of contact says
// nothing, and the listing's is the default.
std::vector<Contact> contacts_of(const AdviceRequest& request, const Sampling& sampling) {
  if (request.scene.walls.empty()) return {Contact::listing};
  const Setting located{"leapfrog", Contact::located, 1};
  if (request.books || !worth_locating(request.scene) ||
      !plan_refusal(request.scene, request.initial, located, sampling).empty()) {
    return {Contact::resolved};
  }
  return {Contact::resolved, Contact::located};
}

// The two methods of the highest order, the highest first.
std::vector<std::string> finest_methods() {
  std::vector<const Method*> all;
  for (const Method& method : methods()) all.push_back(&method);
  std::stable_sort(all.begin(), all.end(),
                   [](const Method* a, const Method* b) { return a->order > b->order; });
  return {std::string(all[0]->name), std::string(all[1]->name)};
}

class Pilot {
 public:
  explicit Pilot(const AdviceRequest& request)
      : request_(request), sampling_(sampling_of(request.scene, looks)) {
    sampling_.exact = false;  // as the run will be
    const OutputSpec& output = request.scene.output;
    longest_step_ = std::min(output.monitor_every, output.frames_every.value_or(longest_step_));
    contacts_ = contacts_of(request, sampling_);
  }

  // The pilot's reference at steps this much smaller, and how well it is known. False if
  // interrupted.
  bool find_reference(double smaller) {
    // With steps as they are: rounded to single precision, they end up to 1e-6 s before or after
    // the course's end. That is an error of the run advised.
    Sampling exact = sampling_;
    exact.exact = true;
    const auto row = run({fine(0, smaller)}, {}, exact, request_.initial);
    if (!row) return false;
    reference_ = row->front().record;
    const auto other = run({fine(1, smaller)}, reference_, exact, request_.initial);
    if (!other) return false;
    known_to_ = error_of(bar_of(other->front().record, reference_), request_.observable);
    // In a collapse two courses may end alike by chance. A third, from a start some roundings away,
    // tells what the motion makes of roundings.
    const Setting again = fine(0, smaller);
    const Problem problem = problem_of(request_.scene, request_.initial, again, exact);
    const State moved =
        disturbed_start(problem, std::max(least_disturbance, rounding_disturbance(problem)));
    const auto third = run({again}, reference_, exact, moved);
    if (!third) return false;
    const double apart = error_of(bar_of(third->front().record, reference_), request_.observable);
    if (!std::isnan(known_to_) && !(apart <= known_to_)) known_to_ = apart;  // a NaN stays
    return true;
  }
  // All that may be advised, at the largest steps and, from the second call on, smaller ones; those
  // of earlier calls once more, as the reference may be a better one. False if interrupted.
  bool run_candidates() {
    std::vector<Setting> all;
    const double decades = smallest_ > 1.0 ? std::log10(finer) : first_decades;
    for (const Setting& kind : kinds()) {
      const int steps = kind.contact == Contact::located ? per_decade_located : per_decade;
      const auto more = settings(kind, {largest_part / smallest_, decades, steps});
      all.insert(all.end(), more.begin(), more.end());
    }
    for (const AccuracyRow& row : rows_) {
      if (std::find(all.begin(), all.end(), row.setting) == all.end()) all.push_back(row.setting);
    }
    auto rows = run(all, reference_, sampling_, request_.initial);
    if (!rows) return false;
    rows_ = std::move(*rows);
    smallest_ *= finer;
    return true;
  }
  [[nodiscard]] double known_to() const { return known_to_; }
  [[nodiscard]] std::size_t courses() const { return courses_; }

  // The cheapest of the rows so far that reaches the error.
  [[nodiscard]] std::optional<Advice> best() const {
    const CourseTimes times =
        time_courses(request_.scene, request_.initial, sampling_, rows_, false);
    std::optional<Advice> best;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double error = error_or_bar(error_of(rows_[i].errors, request_.observable), known_to_);
      if (!(error <= request_.error) || !std::isfinite(times.rows[i])) continue;
      if (best && best->seconds <= times.rows[i]) continue;
      const Setting& setting = rows_[i].setting;
      best = Advice{.setting = setting,
                    .step = sampling_.every / static_cast<double>(setting.steps_a_sample),
                    .error = error,
                    .seconds = times.rows[i],
                    .known_to = known_to_,
                    .unit = unit_of(request_.observable),
                    .pilot_seconds = 0.0,
                    .courses = courses_};
    }
    return best;
  }
  [[nodiscard]] double smallest_error() const {
    if (rows_.empty()) return 0.0;  // none was run: it is known_to() that counts
    double smallest = std::numeric_limits<double>::infinity();
    for (const AccuracyRow& row : rows_) {
      smallest =
          std::min(smallest, error_or_bar(error_of(row.errors, request_.observable), known_to_));
    }
    return smallest;
  }

 private:
  [[nodiscard]] std::vector<Setting> settings(const Setting& kind, const StepSweep& sweep) const {
    auto found = settings_of(request_.scene, request_.initial, kind, sampling_, sweep);
    if (found.empty()) {
      throw NoAdvice(NoAdvice::Why::nothing_vibrates);
    }
    auto fewest = static_cast<std::int64_t>(std::ceil(sampling_.every / longest_step_));
    if (sampling_.every / static_cast<double>(fewest) > longest_step_) ++fewest;  // by a rounding
    for (Setting& each : found) each.steps_a_sample = std::max(each.steps_a_sample, fewest);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }
  [[nodiscard]] std::optional<std::vector<AccuracyRow>> run(const std::vector<Setting>& all,
                                                            const CourseRecord& reference,
                                                            const Sampling& sampling,
                                                            const std::optional<State>& start) {
    courses_ += all.size();
    return measure_accuracy(
        request_.scene, start, all, sampling, reference, request_.threads,
        [this](std::size_t, const AccuracyRow&) { return !(request_.stop && request_.stop()); });
  }
  // The pilot's reference (0), and the course that says how well it is known (1): by the next best
  // method, as resolved contact leaves errors that do not fall as its order says; with located
  // contact by the same one with larger steps, whose error is many times the reference's.
  [[nodiscard]] Setting fine(std::size_t which, double smaller) const {
    const bool located = contacts_.back() == Contact::located;
    const double larger = located && which == 1 ? 1.5 : 1.0;
    Setting found = settings({finest_methods()[located ? 0 : which], contacts_.back(), 1},
                             {larger * pilot_part / smaller, 0.0, per_decade})
                        .front();
    // Where a step is as long as the time between two looks, both would have the same.
    if (which == 0) found.steps_a_sample += found.steps_a_sample / 8 + 1;
    return found;
  }
  // Every method with every contact that is worth trying.
  [[nodiscard]] std::vector<Setting> kinds() const {
    std::vector<Setting> all;
    for (const Method& method : methods()) {
      for (const Contact contact : contacts_) {
        all.push_back({std::string(method.name), contact, 1});
      }
    }
    return all;
  }
  const AdviceRequest& request_;
  Sampling sampling_;
  std::vector<Contact> contacts_;
  // s; the run will be looked at, and write a frame, no more often than each step.
  double longest_step_ = std::numeric_limits<double>::infinity();
  CourseRecord reference_;
  double known_to_ = 0.0;
  double smallest_ = 1.0;  // steps of the next candidates, times smaller than the largest
  std::vector<AccuracyRow> rows_;
  std::size_t courses_ = 0;
};

}  // namespace

bool is_observable(const std::string& name) {
  return name == "position" ||
         std::any_of(observable_names.begin(), observable_names.end(),
                     [&](const ObservableName& each) { return each.name == name; });
}

std::string unit_of(const std::string& observable) {
  for (const ObservableName& each : observable_names) {
    if (each.name == observable) return std::string(each.unit);
  }
  return "cm";
}

std::optional<Advice> advise(const AdviceRequest& request) {
  if (!is_observable(request.observable)) {
    throw std::invalid_argument("no such observable: " + request.observable);
  }
  if (!(request.error > 0.0 && std::isfinite(request.error))) {
    throw std::invalid_argument("an error must be above 0");
  }
  const auto start = Clock::now();
  Pilot pilot(request);
  double smaller = 1.0, known_before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round, smaller *= finer) {
    if (!pilot.find_reference(smaller)) return std::nullopt;
    if (std::isnan(pilot.known_to())) {
      throw NoAdvice(NoAdvice::Why::not_known);
    }
    if (!(margin * pilot.known_to() <= request.error)) {
      // Not known well enough. A finer pilot may know more, but not where this one knew no better
      // than the one before.
      if (!(finer * pilot.known_to() <= known_before)) break;
      known_before = pilot.known_to();
      continue;
    }
    if (!pilot.run_candidates()) return std::nullopt;
    if (auto best = pilot.best()) {
      best->pilot_seconds = std::chrono::duration<double>(Clock::now() - start).count();
      return best;
    }
  }
  throw NoAdvice(NoAdvice::Why::not_reached,
                 std::max(pilot.smallest_error(), margin * pilot.known_to()));
}

}  // namespace bounce
