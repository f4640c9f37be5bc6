// What is kept of a run besides its files: its ledgers, sample by sample, and the figures of its
// bounce, which are looked at apart from the samples.
#pragma once

#include <cstdint>
#include <optional>

#include "kernels/model/problem.hpp"
#include "verify/figures/bounce_gauge.hpp"
#include "verify/watch/ledger.hpp"

namespace bounce {

/// What they found in the end.
struct RunFindings {
  LedgerReport ledger;
  Bounce bounce;
  double time_step = 0.0;        ///< s, nominal
  double integrated_step = 0.0;  ///< s, as it was computed with
};

class RunGauges {
 public:
  /// `time_step` nominal, s; `full`: add() will be given books.
  RunGauges(const Model& model, BounceGauge figures, double time_step, bool full);
  void add(std::int64_t step, const Sample& sample, const State& state,
           const WallBooks* books = nullptr);
  [[nodiscard]] const LedgerInterval& last() const { return ledger_.last(); }

  /// The step of the next look at the run, and the look, from the start on.
  [[nodiscard]] std::int64_t next_look(std::int64_t step) const { return figures_.next(step); }
  void look(const Stepper& stepper) { figures_.look(stepper); }

  /// Of a run that ended where the stepper stands; `back`: what was seen after the last sample is
  /// not to count, as the run had become unstable.
  [[nodiscard]] RunFindings findings(const Stepper& stepper, bool back) const;

  template <class Words>
  void serialize(Words& words) {
    words(ledger_, figures_, at_sample_, start_, now_);
  }

 private:
  Ledger ledger_;
  BounceGauge figures_;
  BounceGauge at_sample_;  // as it was at the last sample
  std::optional<Sample> start_;
  Sample now_;
  double time_step_, integrated_step_;
};

}  // namespace bounce
