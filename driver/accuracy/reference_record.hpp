// What is kept of a scene's two reference solutions: files, and a short table for people.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/world/files.hpp"
#include "kernels/model/scene.hpp"
#include "verify/accuracy/reference_pair.hpp"
#include "verify/figures/bounce.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {

/// A figure of a scene with its error bar: twice the difference of the two solutions, and no less
/// than what either was found to.
struct Observable {
  std::string_view name, unit;
  std::optional<double> value;  ///< of the fixed-step solution; none: it has none
  std::optional<double> error;  ///< none: one of the solutions has no value
};

/// The two solutions, sampled at the output times, and their figures.
struct ReferenceRecord {
  DisturbedPair paths;
  std::vector<Sample> adaptive, fixed;
  Bounce adaptive_bounce, fixed_bounce;
  double disturbance = 0.0;  ///< cm

  [[nodiscard]] const ReferencePair& pair() const { return paths.pair; }
};

/// Samples the paths.
ReferenceRecord make_reference_record(const Problem& problem, DisturbedPair paths,
                                      double disturbance);

/// Height and speed of the centre at the end, rebound height, contact time, energy lost, greatest
/// flattening, restitution, and when and how low.
std::vector<Observable> observables_of(const ReferenceRecord& record);

/// reference.csv: per output time each quantity of the fixed-step solution and, in the column after
/// it, how far the adaptive one is off; largest distance of a particle between the two, and between
/// the adaptive one and its disturbed twin.
void write_reference_csv(OutputFile& file, const ReferenceRecord& record);

/// contacts.csv: events of both solutions.
void write_contacts_csv(OutputFile& file, const ReferenceRecord& record);

/// observables.json: observables, state before the impact, growth, settings, origin.
std::string reference_json(const ReferenceRecord& record, const Scene& scene,
                           const ReferenceSettings& settings, double every,
                           const std::string& scene_name, const std::string& command_line);

/// The same for people, and a sentence where the solutions have parted.
std::string reference_table(const ReferenceRecord& record, const ReferenceSettings& settings);

}  // namespace bounce
