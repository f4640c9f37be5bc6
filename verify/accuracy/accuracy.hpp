// Error against cost: one scene by many settings, each compared with a reference.
//
//  1. Every course is seen at the same times as the reference, so a step is the sampling interval
//     over a whole number.
//  2. Each course is run on the kernel that a plan picks for it on one thread, which is what a user
//     gets; courses side by side.
//  3. How long a step takes is measured apart from that, one setting at a time
//     (driver/course_timing.hpp): cores that are busy with other courses would show in it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/model/scene.hpp"
#include "kernels/model/state.hpp"
#include "verify/accuracy/course.hpp"

namespace bounce {

/// What a user may choose to spend more or less.
struct Setting {
  std::string method;
  Contact contact = Contact::listing;
  std::int64_t steps_a_sample = 1;

  bool operator==(const Setting&) const = default;

  template <class Words>
  void serialize(Words& words) {
    words(method, contact, steps_a_sample);
  }
};

/// When a course is looked at.
struct Sampling {
  double every = 0.01;       ///< s
  std::int64_t samples = 0;  ///< after the start
  /// Steps as they are; else rounded to single precision if the scene says so, as `bounce run`
  /// does.
  bool exact = true;
  [[nodiscard]] double end() const { return every * static_cast<double>(samples); }
};

/// As many intervals of about `every` (s) as make up the scene's time.
Sampling sampling_of(const Scene& scene, double every);

/// How a baseline (baseline.hpp) meets walls: by one of the two rules after a step, or at the very
/// time.
enum class BaselineContact { listing, resolved, located };

/// A setting and what came of it.
struct AccuracyRow {
  Setting setting;
  std::optional<BaselineContact> baseline;  ///< of a baseline; the setting then has its name only
  double tolerance = 0.0;  ///< of an adaptive baseline; its step is the mean one. 0: fixed steps
  double step = 0.0;       ///< s
  std::int64_t steps = 0;  ///< of the whole course
  std::int64_t evaluations = 0;  ///< of the force
  std::string kernel;
  std::string note;  ///< of a baseline that was not finished: why
  CourseRecord record;
  CourseErrors errors;

  template <class Words>
  void serialize(Words& words) {
    words(setting, baseline, tolerance, step, steps, evaluations, kernel, note, record, errors);
  }
};

/// The scene by a setting, whatever the scene itself says of method, step, contact and output.
/// Throws SceneError.
Problem problem_of(const Scene& scene, const std::optional<State>& initial, const Setting& setting,
                   const Sampling& sampling);

/// Whether located contact is worth a try: near a wall it runs in plain code on one thread, which a
/// ball of many particles turns into minutes.
bool worth_locating(const Scene& scene);

/// Why no kernel can run the scene by a setting, whatever its step; "" if one can.
std::string plan_refusal(const Scene& scene, const std::optional<State>& initial,
                         const Setting& setting, const Sampling& sampling);

/// Steps of a sweep, as parts of the method's stable step at the start.
struct StepSweep {
  double part = 0.9;     ///< the largest
  double decades = 3.0;  ///< from there down
  int per_decade = 3;
  int first_finer = 1;  ///< times as many in the first decade, whose courses cost next to nothing
};

/// `kind` at each step of a sweep, the largest first, each a whole part of the sampling interval.
/// Empty if nothing vibrates.
std::vector<Setting> settings_of(const Scene& scene, const std::optional<State>& initial,
                                 const Setting& kind, const Sampling& sampling,
                                 const StepSweep& sweep);

/// Runs all settings; a row each, in their order, whatever the number of threads (0: one a core).
/// A course whose state is not finite has infinite errors; so have all if the reference has no
/// samples (they can then be references themselves). `done` is called as each ends, with its place and
/// its row, never twice at once; if it returns false, the rest is left out and nothing is returned.
std::optional<std::vector<AccuracyRow>> measure_accuracy(
    const Scene& scene, const std::optional<State>& initial, std::span<const Setting> settings,
    const Sampling& sampling, const CourseRecord& reference, int threads,
    const std::function<bool(std::size_t, const AccuracyRow&)>& done);

}  // namespace bounce
