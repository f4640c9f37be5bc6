// monitor.csv: a run's energies, momenta and shape in the course of time.
#pragma once

#include <cstdint>
#include <filesystem>

#include "driver/world/files.hpp"
#include "verify/watch/compensated_sum.hpp"
#include "verify/watch/ledger.hpp"
#include "verify/watch/monitor.hpp"

namespace bounce {

/// One row a sample. t in s; energies as differences from their values at the start (run.json has
/// those), so that no digits are lost; momenta, centre of mass and lowest point in cgs; smallest
/// R/R0 of any bond; number of particles on a wall. Since the start, as the ledger has them: energy
/// from the walls, drift, and the walls' impulse. Last, time step / stable step (MarginGauge::add).
class MonitorCsv {
 public:
  explicit MonitorCsv(const std::filesystem::path& path);
  /// Goes on with a file of which `size` bytes count.
  MonitorCsv(const std::filesystem::path& path, std::uint64_t size) : file_(path, size) {}
  [[nodiscard]] OutputFile& file() { return file_; }
  /// The first sample written is the start.
  void write(double time, const Sample& sample, const LedgerInterval& interval, double stable_part);
  void close() { file_.close(); }
  template <class Words>
  void serialize(Words& words) {
    words(started_, start_, walls_, drift_, impulse_x_, impulse_y_);
  }

 private:
  OutputFile file_;
  bool started_ = false;
  Sample start_;
  CompensatedSum walls_, drift_, impulse_x_, impulse_y_;
};

}  // namespace bounce
