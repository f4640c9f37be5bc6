#include "driver/run/run_gauges.hpp"

namespace bounce {

RunGauges::RunGauges(const Problem& problem, int rings, double time_step, bool full)
    : ledger_(problem, full), bounce_(problem.walls), rings_(rings), time_step_(time_step) {}

void RunGauges::add(std::int64_t step, const Sample& sample, const State& state,
                    const WallBooks* books) {
  const double time = static_cast<double>(step) * time_step_;
  ledger_.add(step, state, sample, books);
  bounce_.add(time, sample, {ledger_.last().contact, ledger_.last().impulse});
  bounce_.add_shape(time, rings_ == 0 ? measure_shape(state) : measure_shape(state, rings_));
}

RunFindings RunGauges::findings() const { return {ledger_.report(), bounce_.result(), time_step_}; }

}  // namespace bounce
