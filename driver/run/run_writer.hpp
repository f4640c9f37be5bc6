// All that a run keeps on its way: its files, and what becomes of its summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "driver/output/extended_xyz.hpp"
#include "driver/output/ledger_csv.hpp"
#include "driver/output/monitor_csv.hpp"
#include "driver/run/run_gauges.hpp"
#include "verify/watch/margin.hpp"
#include "verify/watch/words.hpp"

namespace bounce {

class RunWriter {
 public:
  /// Writes into `folder`. `books`: the stepper's, or null, then there is no ledger.csv. `figures`:
  /// the run's gauge. Problem and books have to outlive it. `from`: goes on with the files of a run
  /// that was written down, as the words have it; throws OutputError if they are shorter than they
  /// were then.
  RunWriter(const Scene& scene, const Problem& problem, std::filesystem::path folder,
            const WallBooks* books, BounceGauge figures, WordReader* from = nullptr);

  void sample(std::int64_t step, const Sample& sample, const State& state);
  void frame(std::int64_t step, const State& state);
  /// BAL4.OUT1 at the first million steps and so on, BAL4.OUT at the end. As in the listing, the
  /// end has no numbered file of its own beyond the nineteenth.
  void listing_frame(std::int64_t step, bool is_end, const State& state);

  /// Writes down what it knows, and how long its files are.
  void write_down(WordWriter& words);
  /// Returns once the files are on the disk.
  void sync();
  /// Looks at the run, at the steps that it asks for.
  [[nodiscard]] std::int64_t next_look(std::int64_t step) const { return gauges_.next_look(step); }
  void look(const Stepper& stepper) { gauges_.look(stepper); }
  /// Closes the files of a run that ended where the stepper stands; `unstable`: that is before the
  /// last steps taken.
  RunFindings finish(const Stepper& stepper, bool unstable);
  [[nodiscard]] std::optional<Margin> margin() const { return margin_.result(); }

 private:
  // Bytes of the files.
  struct Sizes {
    std::uint64_t monitor = 0, ledger = 0, frames = 0;
    template <class Words>
    void serialize(Words& words) {
      words(monitor, ledger, frames);
    }
  };
  static std::optional<Sizes> read_sizes(WordReader* from);
  RunWriter(const Scene& scene, const Problem& problem, std::filesystem::path folder,
            const WallBooks* books, BounceGauge figures, WordReader* from,
            std::optional<Sizes> sizes);
  [[nodiscard]] double time(std::int64_t step) const {
    return static_cast<double>(step) * time_step_;
  }

  std::filesystem::path folder_;
  double time_step_;  // s, nominal
  const WallBooks* books_;
  MonitorCsv monitor_;
  ExtendedXyz frames_;
  std::optional<LedgerCsv> ledger_;
  RunGauges gauges_;
  MarginGauge margin_;
};

}  // namespace bounce
