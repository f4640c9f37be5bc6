#include "driver/accuracy/reference_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/world/origin.hpp"

namespace bounce {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }
Json number(std::optional<double> value) { return value ? number(*value) : Json(); }

std::vector<Sample> sample_path(const Problem& problem, const ReferencePath& path) {
  std::vector<Sample> samples;
  samples.reserve(path.states.size());
  for (const State& state : path.states) samples.push_back(measure(problem, state));
  return samples;
}

// Twice the difference of the two, as that is the error of the worse one give or take the other's,
// and no less than what was found of either is good to, or a rounding.
Observable observable(std::string_view name, std::string_view unit,
                      const std::optional<Figure>& fixed, const std::optional<Figure>& adaptive) {
  Observable result{name, unit, {}, {}};
  if (fixed) result.value = fixed->value;
  if (!fixed || !adaptive) return result;
  const double apart = 2.0 * std::abs(fixed->value - adaptive->value);
  const double rounding = std::abs(fixed->value) * std::numeric_limits<double>::epsilon();
  const double least = std::max({fixed->found_to, adaptive->found_to, rounding});
  result.error = apart <= least ? least : apart;  // a NaN stays
  return result;
}

double end_distance(const ReferencePair& pair) {
  return largest_distance(pair.adaptive.states.back(), pair.fixed.states.back());
}

double distance_before_contact(const ReferencePair& pair) {
  const std::size_t k = pair.last_before_contact();
  return largest_distance(pair.adaptive.states[k], pair.fixed.states[k]);
}

Json path_json(const ReferencePath& path) {
  return {{"steps", path.run.steps},
          {"force_evaluations", path.run.evaluations},
          {"contacts", path.run.events.size()},
          {"height_cut_cm", path.run.height_cut}};
}

// The columns of reference.csv, but for time and distances.
struct Row {
  double centre_x, centre_y, velocity_x, velocity_y, kinetic, bond, gravity, lowest;
  Row(const Sample& s, double particles)
      : centre_x(s.centre.x),
        centre_y(s.centre.y),
        velocity_x(s.momentum.x / particles),
        velocity_y(s.momentum.y / particles),
        kinetic(s.kinetic),
        bond(s.bond),
        gravity(s.gravity),
        lowest(s.lowest) {}
  [[nodiscard]] std::array<double, 8> values() const {
    return {centre_x, centre_y, velocity_x, velocity_y, kinetic, bond, gravity, lowest};
  }
};
constexpr std::array<std::string_view, 8> row_names{"cx",      "cy",   "vx",      "vy",
                                                    "kinetic", "bond", "gravity", "lowest"};

}  // namespace

ReferenceRecord make_reference_record(const Problem& problem, DisturbedPair paths,
                                      double disturbance) {
  ReferenceRecord record;
  record.paths = std::move(paths);
  record.disturbance = disturbance;
  for (const auto& [path, samples, bounce] :
       {std::tuple(&record.pair().adaptive, &record.adaptive, &record.adaptive_bounce),
        std::tuple(&record.pair().fixed, &record.fixed, &record.fixed_bounce)}) {
    *samples = sample_path(problem, *path);
    *bounce = path->bounce;
    bounce->energy_lost = energy_lost(samples->front(), samples->back());
  }
  return record;
}

std::vector<Observable> observables_of(const ReferenceRecord& record) {
  constexpr std::array order{&Bounce::end_height,
                             &Bounce::end_speed,
                             &Bounce::rebound_height,
                             &Bounce::contact_time,
                             &Bounce::energy_lost,
                             &Bounce::greatest_flattening,
                             &Bounce::greatest_flattening_time,
                             &Bounce::restitution,
                             &Bounce::lowest_centre,
                             &Bounce::lowest_centre_time,
                             &Bounce::first_contact,
                             &Bounce::last_contact};
  std::vector<Observable> all;
  for (const auto figure : order) {
    const auto name = std::find_if(figure_names.begin(), figure_names.end(),
                                   [&](const FigureName& each) { return each.figure == figure; });
    all.push_back(observable(name->name, name->unit, record.fixed_bounce.*figure,
                             record.adaptive_bounce.*figure));
  }
  return all;
}

void write_reference_csv(OutputFile& file, const ReferenceRecord& record) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "t");
  for (const std::string_view name : row_names) fmt::format_to(out, ",{0},{0}_diff", name);
  fmt::format_to(out, ",position_diff,disturbed_by\n");
  const ReferencePair& pair = record.pair();
  const auto particles = static_cast<double>(pair.fixed.states.front().size());
  for (std::size_t k = 0; k < pair.times.size(); ++k) {
    const auto fixed = Row(record.fixed[k], particles).values();
    const auto adaptive = Row(record.adaptive[k], particles).values();
    fmt::format_to(out, "{:.12g}", pair.times[k]);
    for (std::size_t c = 0; c < fixed.size(); ++c) {
      fmt::format_to(out, ",{},{:.3g}", fixed[c], adaptive[c] - fixed[c]);
    }
    fmt::format_to(out, ",{:.3g},{:.3g}\n",
                   largest_distance(pair.adaptive.states[k], pair.fixed.states[k]),
                   largest_distance(pair.adaptive.states[k], record.paths.disturbed.states[k]));
    file.write_large(text);
  }
  file.write({text.data(), text.size()});
}

void write_contacts_csv(OutputFile& file, const ReferenceRecord& record) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "solution,t,particle,wall,what\n");
  const auto add = [&](std::string_view name, const ReferencePath& path) {
    for (const ContactEvent& event : path.run.events) {
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", name, event.time,
                     event.particle + 1, event.wall, name_of(event.kind));
      file.write_large(text);
    }
  };
  add("fixed", record.pair().fixed);
  add("adaptive", record.pair().adaptive);
  file.write({text.data(), text.size()});
}

std::string reference_json(const ReferenceRecord& record, const Scene& scene,
                           const ReferenceSettings& settings, double every,
                           const std::string& scene_name, const std::string& command_line) {
  const ReferencePair& pair = record.pair();
  const Growth growth = growth_of(record.paths);
  const Origin origin = find_origin();
  Json observables;
  for (const Observable& each : observables_of(record)) {
    observables[std::string(each.name)] = {
        {"value", number(each.value)}, {"error", number(each.error)}, {"unit", each.unit}};
  }
  const bool contact = !pair.fixed.run.events.empty() || !pair.adaptive.run.events.empty();
  Json json{{"scene", scene_name},
            {"end", scene.time.end},
            {"every", every},
            {"observables", observables},
            {"before_impact",
             {{"t", pair.times[pair.last_before_contact()]},
              {"first_contact", contact ? number(pair.first_contact()) : Json()},
              {"position_error", number(distance_before_contact(pair))}}},
            {"end_position_error", number(end_distance(pair))},
            {"growth",
             {{"disturbed_by", record.disturbance},
              {"start", number(growth.start)},
              {"at_contact", number(growth.contact)},
              {"end", number(growth.end)},
              {"greatest", number(growth.greatest)},
              {"factor", number(growth.factor())},
              {"rate", number(growth.rate)}}},
            {"adaptive", path_json(pair.adaptive)},
            {"fixed", path_json(pair.fixed)},
            {"origin",
             {{"command", command_line},
              {"version", origin.version},
              {"commit", origin.commit},
              {"compiler", origin.compiler},
              {"flags", origin.flags},
              {"cpu", origin.cpu},
              {"cores", origin.cores},
              {"date", origin.date}}}};
  json["adaptive"]["tolerance"] = settings.adaptive.tolerance;
  json["fixed"]["step"] = settings.fixed.step;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string reference_table(const ReferenceRecord& record, const ReferenceSettings& settings) {
  const ReferencePair& pair = record.pair();
  const Growth growth = growth_of(record.paths);
  const auto solution = [](std::string_view name, std::string_view method,
                           const ReferencePath& path) {
    return fmt::format("{:<9} {}: {} steps, {} force evaluations, {} contacts\n", name, method,
                       path.run.steps, path.run.evaluations, path.run.events.size());
  };
  std::string text =
      solution("adaptive", fmt::format("rk8pd, double, tolerance {}", settings.adaptive.tolerance),
               pair.adaptive) +
      solution("fixed", fmt::format("SRKN_11^b, long double, step {:.4g} s", settings.fixed.step),
               pair.fixed);
  text += fmt::format("\n{:<25} {:>20}  {:>9}  {}\n", "observable", "value", "error", "unit");
  for (const Observable& each : observables_of(record)) {
    text += fmt::format("{:<25} {:>20}  {:>9}  {}\n", each.name,
                        each.value ? fmt::format("{:.13g}", *each.value) : "-",
                        each.error ? fmt::format("{:.1e}", *each.error) : "-", each.unit);
  }
  const bool touches = !pair.adaptive.run.events.empty() || !pair.fixed.run.events.empty();
  text += "\nLargest difference of a position: ";
  if (touches) {
    text += fmt::format("{:.1e} cm at t = {:.6g} s, before the first contact; ",
                        distance_before_contact(pair), pair.times[pair.last_before_contact()]);
  }
  text += fmt::format("{:.1e} cm at the end.\nA start disturbed by {:.1e} cm is ",
                      end_distance(pair), growth.start);
  if (touches) text += fmt::format("{:.1e} cm off at the first contact, ", growth.contact);
  text += fmt::format("{:.1e} cm at the end: times {:.2g}", growth.end, growth.factor());
  text += std::isfinite(growth.rate) ? fmt::format(", {:+.2f} e-folds a second.\n", growth.rate)
                                     : std::string(".\n");
  // A distance as large as that is no error bar of a position any more.
  constexpr double parted = 1e-3;  // cm
  if (!(end_distance(pair) <= parted)) {
    text +=
        "The two solutions have parted: they agree on no particle's place at the end. The motion "
        "amplifies what arithmetic leaves open; the errors above say what is still known.\n";
  }
  return text;
}

}  // namespace bounce
