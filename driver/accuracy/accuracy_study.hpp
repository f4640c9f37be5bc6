// What bounce accuracy compares with what: its options, checked, as a list of settings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "driver/scene/scene_file.hpp"
#include "kernels/model/state.hpp"
#include "verify/accuracy/accuracy.hpp"

namespace bounce {

/// What a user asks for.
struct StudyRequest {
  std::string scene;
  std::vector<std::string> settings;  ///< key=value
  std::string initial;                ///< file of the initial state, or ""
  std::vector<std::string> methods;   ///< and baselines; none: all
  std::vector<std::string> contacts;  ///< of those that a method has; none: all
  std::vector<double> steps;          ///< s, besides those of the sweep
  double every = 0.01;                ///< s
  StepSweep sweep;
  bool quick = false;

  [[nodiscard]] bool wants(std::string_view method) const;
  [[nodiscard]] bool wants(Contact contact) const;
};

struct Study {
  SceneFile file;
  Scene scene;
  std::optional<State> initial;
  Sampling sampling;
  std::optional<Setting> papers;  ///< the paper's program, one of these; see left_out if not
  std::vector<Setting> settings;
  std::vector<std::string> left_out;  ///< what cannot be run, and why
};

/// Throws InputError, SceneError.
Study make_study(const StudyRequest& request);

}  // namespace bounce
