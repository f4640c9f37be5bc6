// What one run of a scene leaves to be compared: observables, energies, and the ball just before
// the impact. A run and a reference are seen at the same times by the same gauge, so what sampling
// does to a value it does to both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {

/// What a person would measure of a course, cgs (unit masses); NaN where it is not known.
struct Observables {
  double height = std::numeric_limits<double>::quiet_NaN();  ///< of the centre at the end, cm
  double speed = height;                                     ///< of the centre at the end, cm/s
  double rebound = height;     ///< greatest height of the centre from the lowest on, cm
  double contact = height;     ///< time in which a particle touched a wall, s
  double lost = height;        ///< energy at the start less at the end, erg
  double flattening = height;  ///< greatest
};

/// A member of Observables by name.
struct ObservableName {
  std::string_view name, unit;
  double Observables::*value;
};
inline constexpr std::array<ObservableName, 6> observable_names{{
    {"height", "cm", &Observables::height},
    {"speed", "cm/s", &Observables::speed},
    {"rebound", "cm", &Observables::rebound},
    {"contact_time", "s", &Observables::contact},
    {"energy_lost", "erg", &Observables::lost},
    {"flattening", "", &Observables::flattening},
}};

/// A course as it was seen.
struct CourseRecord {
  Observables observables;
  std::vector<double> energy;    ///< at each sample, erg
  std::size_t free_samples = 0;  ///< samples before the first contact
  State before;                  ///< at the last of them
  double lowest_time = 0.0;      ///< when the centre was lowest, s
  bool finite = true;            ///< false: a state was not; the rest is then of no worth
};

/// Sees the samples of one course in the order of time.
class CourseGauge {
 public:
  /// `rings`: 0 for a ball without. `free_samples`: how many samples of the course to compare with
  /// lie before its first contact; nothing: this is that course, and finds out. The problem has to
  /// outlive the gauge.
  CourseGauge(const Problem& problem, int rings, std::optional<std::size_t> free_samples = {});
  /// False if the state is not finite; nothing more can be added then.
  bool add(double time, const State& state);
  [[nodiscard]] CourseRecord result() const { return record_; }

 private:
  void add_contact(double time, double nearest);
  void keep_states(const State& state, const Sample& sample, double time, double nearest);

  const Problem* problem_;
  int rings_;
  bool find_contact_;
  CourseRecord record_;
  bool any_ = false, touched_ = false;
  double start_energy_ = 0.0, lowest_ = 0.0;
  double last_time_ = 0.0, last_nearest_ = 0.0;
};

/// How far one course is off another.
struct CourseErrors {
  Observables observables;  ///< absolute differences
  double position = 0.0;  ///< largest of a particle, at the other's last sample before contact, cm
  double energy_free = 0.0;  ///< largest change of energy since the start, until then, erg
  double energy = 0.0;       ///< largest difference of energy from the other's, at any sample, erg
};
/// All infinite if `course` is not finite. Both must have seen the same times.
CourseErrors errors_of(const CourseRecord& course, const CourseRecord& reference);

/// The larger of each; a NaN if one is.
CourseErrors larger_of(const CourseErrors& a, const CourseErrors& b);

/// What an error is set against: below its own uncertainty (the reference's) it counts as that.
double error_or_bar(double error, double bar);

}  // namespace bounce
