#include "driver/run/advice_text.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/scene/scene_keys.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/interrupt.hpp"

namespace bounce {
namespace {

void check(const AdviceRequest& request) {
  if (!is_observable(request.observable)) {
    std::vector<std::string> names{"position"};
    for (const ObservableName& each : observable_names) names.emplace_back(each.name);
    throw InputError(fmt::format("--observable {}: unknown; allowed is {}", request.observable,
                                 fmt::join(names, ", ")));
  }
  if (!(request.error > 0.0 && std::isfinite(request.error))) {
    throw InputError(fmt::format("--error {}: allowed is a number above 0", request.error));
  }
}

std::string text_of(const NoAdvice& none, const AdviceRequest& request) {
  switch (none.why) {
    case NoAdvice::Why::nothing_vibrates:
      return "there is nothing to advise on: nothing vibrates in this scene";
    case NoAdvice::Why::not_known:
      return fmt::format(
          "--observable {}: allowed is another; of this course it is not known (places are "
          "compared "
          "before the first contact, and it may start with one)",
          request.observable);
    case NoAdvice::Why::not_reached:
      break;
  }
  return fmt::format(
      "--error {}: nothing reaches it; the smallest error of {} that something here is known to "
      "reach is {:.2g} {}",
      request.error, request.observable, none.smallest, unit_of(request.observable));
}

}  // namespace

std::optional<Advice> ask_advice(AdviceRequest request) {
  check(request);
  request.stop = interrupted;
  try {
    return advise(request);
  } catch (const NoAdvice& none) {
    throw InputError(text_of(none, request));
  }
}

std::string describe(const Advice& advice, const AdviceRequest& request) {
  return fmt::format(
      "method {}, contact {}, time step {:.6g} s\n"
      "forecast: error of {} {:.1e} {} (asked {:g}; known to {:.0e}), run {:.2g} s on one thread "
      "without output\n"
      "found by {} courses in {:.1f} s",
      advice.setting.method, word_of(advice.setting.contact), advice.step, request.observable,
      advice.error, advice.unit, request.error, advice.known_to, advice.seconds, advice.courses,
      advice.pilot_seconds);
}

std::vector<std::string> settings_of(const Advice& advice, const Scene& scene) {
  std::vector<std::string> settings{fmt::format("time.method={}", advice.setting.method),
                                    fmt::format("time.step={}", advice.step)};
  if (!scene.walls.empty()) {
    settings.push_back(fmt::format("wall.contact={}", word_of(advice.setting.contact)));
  }
  return settings;
}

}  // namespace bounce
