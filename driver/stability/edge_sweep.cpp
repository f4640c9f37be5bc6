#include "driver/stability/edge_sweep.hpp"

#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "driver/stability/edge_row.hpp"
#include "verify/stability/bounce_run.hpp"

namespace bounce {
namespace {

class Sweep {
 public:
  explicit Sweep(const SweepRequest& request) : request_(request) {
    const Problem problem = make_problem(request.scene, request.initial);
    bounces_ = !request.flight_only && !problem.walls.empty();
    if (bounces_) {
      own_speed_ = meeting_speed(problem);
      bounces_ = own_speed_ > 0.0 || !request.speeds.empty();
    }
  }

  std::vector<SweepCase> make() {
    for (const std::string& method : request_.methods) {
      base_.scene = request_.scene;
      base_.initial = request_.initial;
      base_.criterion = request_.criterion;
      base_.scene.time.method = method;
      add_passage(Passage::flight);
      add_strict_limit();
      add_disturbances();
      if (!bounces_) continue;
      add_passage(Passage::bounce);
      add_impacts();
    }
    return std::move(cases_);
  }

 private:
  void add(const EdgeCase& edge) {
    if (edge.passage == Passage::bounce && !(edge.speed > 0.0)) return;
    std::string key = edge_key(edge);
    if (!seen_.insert(key).second) return;
    cases_.push_back({std::move(key), edge});
  }

  [[nodiscard]] EdgeCase start(Passage passage) const {
    EdgeCase edge = base_;
    edge.passage = passage;
    edge.speed = passage == Passage::bounce ? own_speed_ : 0.0;
    return edge;
  }

  void add_passage(Passage passage) {
    EdgeCase edge = start(passage);
    for (const double e : request_.elasticities) {
      edge.scene.law.elasticity = e;
      add(edge);
    }
    edge = start(passage);
    add(edge);
    edge.sought = Sought::elasticity;
    edge.scene.time.step = request_.step;
    add(edge);
    add_criteria(passage);
  }

  void add_criteria(Passage passage) {
    EdgeCase edge = start(passage);
    for (const double factor : {0.1, 10.0}) {
      edge.criterion = request_.criterion;
      edge.criterion.growth *= factor;
      add(edge);
      if (passage == Passage::bounce) continue;  // it lasts as long as a bounce
      edge.criterion = request_.criterion;
      edge.criterion.periods *= factor;
      add(edge);
    }
  }

  // So long a flight that the first unstable window shows, where the criterion lets it pass.
  void add_strict_limit() {
    EdgeCase edge = start(Passage::flight);
    const double periods =
        periods_for_strict_limit(edge.scene, edge.initial, edge.criterion.growth);
    if (!(periods > edge.criterion.periods && std::isfinite(periods))) return;
    edge.criterion.periods = std::strtod(fmt::format("{:.2g}", periods).c_str(), nullptr);
    add(edge);
  }

  void add_disturbances() {
    EdgeCase edge = start(Passage::flight);
    edge.criterion.periods *= 10.0;  // such a loss takes its time
    for (const double size : request_.disturbances) {
      edge.disturbance = size;
      add(edge);
    }
  }

  void add_impacts() {
    for (const double speed : request_.speeds) {
      EdgeCase edge = start(Passage::bounce);
      edge.speed = speed;
      add(edge);
    }
    const double g = std::hypot(base_.scene.gravity.x, base_.scene.gravity.y);
    for (const double gravity : request_.gravities) {
      EdgeCase edge = start(Passage::bounce);
      // In the direction of the scene's own.
      edge.scene.gravity =
          g > 0.0 ? Vec2{base_.scene.gravity.x / g * gravity, base_.scene.gravity.y / g * gravity}
                  : Vec2{0.0, -gravity};
      if (gravity == 0.0) edge.scene.gravity = {};
      add(edge);
    }
  }

  const SweepRequest& request_;
  bool bounces_ = false;
  double own_speed_ = 0.0;
  EdgeCase base_;
  std::vector<SweepCase> cases_;
  std::set<std::string> seen_;
};

}  // namespace

std::vector<SweepCase> make_sweep(const SweepRequest& request) { return Sweep(request).make(); }

std::vector<double> elasticity_range(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double part = count == 1 ? 0.0 : static_cast<double>(i) / (count - 1);
    const double value = std::exp(std::log(from) + part * (std::log(to) - std::log(from)));
    values.push_back(std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr));
  }
  return values;
}

}  // namespace bounce
