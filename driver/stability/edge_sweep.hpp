// The cases of bounce stability: which edges of a scene are measured, in which order.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/model/scene.hpp"
#include "kernels/model/state.hpp"
#include "verify/stability/stability_edge.hpp"

namespace bounce {

/// What a user asks for. Lists are in the order in which they are measured.
struct SweepRequest {
  Scene scene;
  std::optional<State> initial;
  std::vector<std::string> methods;  ///< names
  std::vector<double> elasticities;
  double step = 0.0;           ///< s, at which the largest E is sought
  std::vector<double> speeds;  ///< of impacts at the scene's E and g, cm/s
  std::vector<double>
      gravities;  ///< towards the wall, of impacts at the scene's E and speed, cm/s^2
  std::vector<double> disturbances;  ///< of flights at the scene's E, in shortest bonds
  bool flight_only = false;
  EdgeCriterion criterion;
};

/// One row of the sweep.
struct SweepCase {
  std::string key;  ///< what is asked, as the first columns of edge.csv
  EdgeCase edge;
};

/// For each method: free flight and bounce over E at the scene's speed of impact; the largest E at
/// the given step; a flight long enough to show the first unstable window, where the criterion does
/// not; flights over disturbance, bounces over speed and over gravity at the scene's E;
/// flight and bounce at the scene's E once more by criteria ten times stricter and looser. Each
/// case once. Throws SceneError.
std::vector<SweepCase> make_sweep(const SweepRequest& request);

/// E from `from` to `to`, evenly on a logarithmic scale, rounded to four digits; 1 is `from` alone.
std::vector<double> elasticity_range(double from, double to, int count);

}  // namespace bounce
