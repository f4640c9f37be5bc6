// What one run of a scene leaves to be compared: observables (of the figures in
// verify/figures/bounce.hpp), energies at the same times as a reference's, and the ball just before
// the impact.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/figures/bounce.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {

/// What a person would measure of a course, cgs (unit masses); NaN where it is not known.
struct Observables {
  double height = std::numeric_limits<double>::quiet_NaN();  ///< of the centre at the end, cm
  double speed = height;                                     ///< of the centre at the end, cm/s
  double rebound = height;     ///< greatest height of the centre from the lowest on, cm
  double contact = height;     ///< time of all impacts, s
  double lost = height;        ///< energy at the start less at the end, erg
  double flattening = height;  ///< greatest

  template <class Words>
  void serialize(Words& words) {
    words(height, speed, rebound, contact, lost, flattening);
  }
};

/// A member of Observables by name.
struct ObservableName {
  std::string_view name, unit;
  double Observables::*value;
  std::optional<Figure> Bounce::*figure;  ///< what it is in the output of a run
};
inline constexpr std::array<ObservableName, 6> observable_names{{
    {"height", "cm", &Observables::height, &Bounce::end_height},
    {"speed", "cm/s", &Observables::speed, &Bounce::end_speed},
    {"rebound", "cm", &Observables::rebound, &Bounce::rebound_height},
    {"contact_time", "s", &Observables::contact, &Bounce::contact_time},
    {"energy_lost", "erg", &Observables::lost, &Bounce::energy_lost},
    {"flattening", "", &Observables::flattening, &Bounce::greatest_flattening},
}};

/// A course as it was seen.
struct CourseRecord {
  Observables observables;
  Observables found_to;          ///< how far the search for each may be off this course
  std::vector<double> energy;    ///< at each sample, erg
  std::size_t free_samples = 0;  ///< samples before the first contact
  State before;                  ///< at the last of them
  double lowest_time = 0.0;      ///< when the centre was lowest, s
  bool finite = true;            ///< false: a state was not; the rest is then of no worth

  template <class Words>
  void serialize(Words& words) {
    words(observables, found_to, energy, free_samples, before, lowest_time, finite);
  }
};

/// Sees the samples of one course in the order of time.
class CourseGauge {
 public:
  /// `free_samples`: how many samples of the course to compare with lie before its first contact;
  /// nothing: of all samples none is kept as the one before the impact. The problem has to outlive
  /// the gauge.
  explicit CourseGauge(const Problem& problem, std::optional<std::size_t> free_samples = {});
  /// False if the state is not finite; nothing more can be added then.
  bool add(const State& state);
  /// With the figures that were found of the course; what energy is lost comes from the samples.
  [[nodiscard]] CourseRecord result(Bounce bounce) const;

 private:
  const Problem* problem_;
  CourseRecord record_;
  std::optional<Sample> start_;
  Sample now_;
};

/// How far one course is off another.
struct CourseErrors {
  Observables observables;  ///< absolute differences
  double position = 0.0;  ///< largest of a particle, at the other's last sample before contact, cm
  double energy_free = 0.0;  ///< largest change of energy since the start, until then, erg
  double energy = 0.0;       ///< largest difference of energy from the other's, at any sample, erg

  template <class Words>
  void serialize(Words& words) {
    words(observables, position, energy_free, energy);
  }
};
/// All infinite if `course` is not finite. Both must have seen the same times.
CourseErrors errors_of(const CourseRecord& course, const CourseRecord& reference);

/// What two courses that claim to be the same differ by, and no less than what was found of either
/// is good to.
CourseErrors bar_of(const CourseRecord& course, const CourseRecord& reference);

/// The larger of each; a NaN if one is.
CourseErrors larger_of(const CourseErrors& a, const CourseErrors& b);

/// What an error is set against: below its own uncertainty (the reference's) it counts as that.
double error_or_bar(double error, double bar);

}  // namespace bounce
