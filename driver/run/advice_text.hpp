// Advice (verify/accuracy/advice.hpp) in the words of the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verify/accuracy/advice.hpp"

namespace bounce {

/// advise(), stopped by Ctrl-C: nothing then. Throws InputError naming the option, for an
/// observable that does not exist or that the run does not have, an error that is not above 0 or
/// that nothing reaches, with the smallest that something does, and a scene in which nothing
/// vibrates.
std::optional<Advice> ask_advice(AdviceRequest request);

/// The advice and its forecasts, for a person: some lines, without an end of line.
std::string describe(const Advice& advice, const AdviceRequest& request);

/// The advice as keys and values of the scene: "time.step=0.001" and so on.
std::vector<std::string> settings_of(const Advice& advice, const Scene& scene);

}  // namespace bounce
