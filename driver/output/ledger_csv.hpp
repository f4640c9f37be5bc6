// ledger.csv: what the walls and the integrator did from sample to sample (bounce run --ledger).
#pragma once

#include <cstdint>
#include <filesystem>

#include "driver/world/files.hpp"
#include "verify/watch/ledger.hpp"

namespace bounce {

/// One row an interval between two samples, t at its end, s. Changes of the ball's energies by
/// reflections, the integrator's drift and swing, erg; the walls' impulse, cm/s, and torque about
/// the centre of mass, cm^2/s; what is left over of momentum and angular momentum.
class LedgerCsv {
 public:
  explicit LedgerCsv(const std::filesystem::path& path);
  /// Goes on with a file of which `size` bytes count.
  LedgerCsv(const std::filesystem::path& path, std::uint64_t size) : file_(path, size) {}
  [[nodiscard]] OutputFile& file() { return file_; }
  void write(double time, const LedgerInterval& interval);
  void close() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace bounce
