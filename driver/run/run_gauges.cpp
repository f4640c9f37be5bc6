#include "driver/run/run_gauges.hpp"

#include <utility>

namespace bounce {

RunGauges::RunGauges(const Model& model, BounceGauge figures, double time_step, bool full)
    : ledger_(model, full),
      figures_(std::move(figures)),
      at_sample_(figures_),
      time_step_(time_step),
      integrated_step_(model.step) {}

void RunGauges::add(std::int64_t step, const Sample& sample, const State& state,
                    const WallBooks* books) {
  ledger_.add(step, state, sample, books);
  at_sample_ = figures_;
  if (!start_) start_ = sample;
  now_ = sample;
}

RunFindings RunGauges::findings(const Stepper& stepper, bool back) const {
  BounceGauge figures = back ? at_sample_ : figures_;
  figures.look(stepper);
  RunFindings findings{ledger_.report(), figures.result(), time_step_, integrated_step_};
  if (start_) findings.bounce.energy_lost = energy_lost(*start_, now_);
  return findings;
}

}  // namespace bounce
