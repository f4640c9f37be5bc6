// What is kept of a run besides its files: its ledgers and its bounce, sample by sample.
#pragma once

#include <cstdint>

#include "kernels/model/problem.hpp"
#include "verify/watch/ledger.hpp"
#include "verify/watch/observables.hpp"

namespace bounce {

/// What they found in the end.
struct RunFindings {
  LedgerReport ledger;
  Bounce bounce;
  double time_step = 0.0;  ///< s, nominal
};

class RunGauges {
 public:
  /// `rings` as Shape wants them, 0: a ball without; `time_step` nominal, s; `full`: add() will be
  /// given books.
  RunGauges(const Problem& problem, int rings, double time_step, bool full);
  void add(std::int64_t step, const Sample& sample, const State& state,
           const WallBooks* books = nullptr);
  [[nodiscard]] const LedgerInterval& last() const { return ledger_.last(); }
  [[nodiscard]] RunFindings findings() const;
  template <class Words>
  void serialize(Words& words) {
    words(ledger_, bounce_);
  }

 private:
  Ledger ledger_;
  BounceGauge bounce_;
  int rings_;
  double time_step_;
};

}  // namespace bounce
