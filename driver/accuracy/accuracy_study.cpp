#include "driver/accuracy/accuracy_study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/scene/load_problem.hpp"
#include "driver/scene/memory_check.hpp"
#include "driver/scene/scene_keys.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/limits.hpp"
#include "kernels/model/ball.hpp"
#include "kernels/model/method.hpp"
#include "verify/accuracy/baseline.hpp"

namespace bounce {
namespace {

constexpr double papers_step = 1e-6;  // s
// Near the stable step, where the cheapest that will do is looked for, errors swing from one step
// to the next: steps a fifth apart there.
constexpr int first_finer = 4;

void check_names(const StudyRequest& request) {
  for (const std::string& name : request.methods) {
    if (find_method(name) != nullptr || is_baseline(name)) continue;
    std::vector<std::string> all;
    for (const Method& method : methods()) all.emplace_back(method.name);
    for (const Baseline& baseline : baselines()) {
      if (all.back() != baseline.name) all.emplace_back(baseline.name);
    }
    throw InputError(
        fmt::format("--methods {}: unknown; allowed is {}", name, fmt::join(all, ", ")));
  }
  for (const std::string& word : request.contacts) {
    if (contact_of(word)) continue;
    throw InputError(fmt::format("--contacts {}: unknown; allowed is {}", word, contact_words()));
  }
}

void check_numbers(const StudyRequest& request, const Scene& scene) {
  if (!(request.every > 0.0 && request.every <= scene.time.end / 10.0)) {
    throw InputError(fmt::format("--every {}: allowed is above 0, at most a tenth of time.end = {}",
                                 request.every, scene.time.end));
  }
  check_path_memory(ball_size(scene.ball).particles, scene.time.end / request.every);
  const StepSweep& sweep = request.sweep;
  if (!(sweep.decades > 0.0 && sweep.decades <= 6.0)) {
    throw InputError(fmt::format("--decades {}: allowed is above 0, at most 6", sweep.decades));
  }
  if (sweep.per_decade < 1 || sweep.per_decade > 100) {
    throw InputError(fmt::format("--per-decade {}: allowed is 1 to 100", sweep.per_decade));
  }
}

// Of a sample: some 1e-11 s, far below any of use, far from overflow.
constexpr double most_steps = 1e9;

// Steps of that length in a sampling interval; nothing if, beyond roundings of the nearest whole
// number, the step would not be the asked one.
std::optional<std::int64_t> whole_part(double step, const Sampling& sampling) {
  const double steps = sampling.every / step;
  constexpr double roundings = 1e-9;
  if (step > 0.0 && steps < most_steps && std::round(steps) >= 1.0 &&
      std::abs(steps - std::round(steps)) <= roundings * steps) {
    return std::llround(steps);
  }
  return {};
}

std::int64_t steps_a_sample(double step, const Sampling& sampling) {
  if (const auto steps = whole_part(step, sampling)) return *steps;
  throw InputError(fmt::format(
      "--steps {}: allowed is a whole part of {} s, the time between two looks, at least {:.0e} s",
      step, sampling.every, sampling.every / most_steps));
}

// The paper's rule beside its own scheme and the simplest other one; located contact where it does
// not take too long.
std::vector<Contact> contacts_of(const Scene& scene, const Method& method) {
  if (scene.walls.empty()) return {Contact::resolved};
  std::vector<Contact> contacts{Contact::resolved};
  if (method.evaluations == 1) contacts.insert(contacts.begin(), Contact::listing);
  if (worth_locating(scene)) contacts.push_back(Contact::located);
  return contacts;
}

// A method of many evaluations, and of an order that needs no small steps, meets the roundings a
// decade before the others where contacts are located. There its sweep may end, which else takes
// half of the study's time.
double decades_of(const Setting& kind, double decades) {
  const bool early = kind.contact == Contact::located && find_method(kind.method)->evaluations > 1;
  return early ? std::max(decades - 1.0, 0.5 * decades) : decades;
}

// A line of the plot: one kind of setting at all its steps.
void add_line(const Setting& kind, const StudyRequest& request, Study& study) {
  if (const std::string why = plan_refusal(study.scene, study.initial, kind, study.sampling);
      !why.empty()) {
    study.left_out.push_back(fmt::format("{}, {}: {}", kind.method, word_of(kind.contact), why));
    return;
  }
  StepSweep sweep = request.sweep;
  if (request.quick) sweep.decades = std::min(sweep.decades, 1.5);
  if (request.quick) sweep.per_decade = std::min(sweep.per_decade, 2);
  if (!request.quick) sweep.first_finer = first_finer;
  sweep.decades = decades_of(kind, sweep.decades);
  auto line = settings_of(study.scene, study.initial, kind, study.sampling, sweep);
  for (const double step : request.steps) {
    Setting setting = kind;
    setting.steps_a_sample = steps_a_sample(step, study.sampling);
    if (std::find(line.begin(), line.end(), setting) == line.end()) line.push_back(setting);
  }
  std::stable_sort(line.begin(), line.end(), [](const Setting& a, const Setting& b) {
    return a.steps_a_sample < b.steps_a_sample;
  });
  study.settings.insert(study.settings.end(), line.begin(), line.end());
}

// The paper's program, unless there is no wall or its step is no part of the time between two
// looks.
void add_papers(Study& study) {
  if (study.scene.walls.empty()) return;
  const auto steps = whole_part(papers_step, study.sampling);
  if (!steps) {
    study.left_out.push_back(
        fmt::format("the paper's program: its step of {} s is no whole part of {} s, the time "
                    "between two looks",
                    papers_step, study.sampling.every));
    return;
  }
  study.papers = {"listing", Contact::listing, *steps};
  auto& all = study.settings;
  if (std::find(all.begin(), all.end(), *study.papers) == all.end()) {
    all.insert(all.begin(), *study.papers);
  }
}

}  // namespace

bool StudyRequest::wants(std::string_view method) const {
  return methods.empty() || std::find(methods.begin(), methods.end(), method) != methods.end();
}

bool StudyRequest::wants(Contact contact) const {
  return contacts.empty() ||
         std::find(contacts.begin(), contacts.end(), word_of(contact)) != contacts.end();
}

Study make_study(const StudyRequest& request) {
  SceneFile file = SceneFile::find(request.scene);
  for (const std::string& setting : request.settings) file.set(setting);
  if (!request.initial.empty()) file.note_origin("initial state", request.initial);
  check_memory(file, "auto", available_memory());
  std::optional<State> start = load_start(request.initial);
  load_problem(file, start);  // throws what is wrong with it
  Study study{std::move(file), {}, std::move(start), {}, {}, {}, {}};
  study.scene = study.file.scene();
  check_names(request);
  check_numbers(request, study.scene);
  study.sampling = sampling_of(study.scene, request.every);
  // Here, too, for those who ask for baselines alone, which have no lines.
  for (const double step : request.steps) static_cast<void>(steps_a_sample(step, study.sampling));
  for (const Method& method : methods()) {
    if (!request.wants(method.name)) continue;
    const std::string name(method.name);
    const std::size_t before = study.settings.size() + study.left_out.size();
    for (const Contact contact : contacts_of(study.scene, method)) {
      if (request.wants(contact)) add_line({name, contact, 1}, request, study);
    }
    if (study.settings.size() + study.left_out.size() == before) {
      study.left_out.push_back(fmt::format("{}: it has none of the contacts asked for", name));
    }
  }
  add_papers(study);
  const auto& all = study.settings;
  if (all.empty() && !study.left_out.empty()) throw InputError(study.left_out.front());
  return study;
}

}  // namespace bounce
