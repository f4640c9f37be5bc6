#include "driver/output/ledger_csv.hpp"

#include <fmt/format.h>

namespace bounce {

LedgerCsv::LedgerCsv(const std::filesystem::path& path) : file_(path) {
  file_.write(
      "t,reflections,kinetic,gravity,bond,drift,swing,impulse_x,impulse_y,torque,residual_px,"
      "residual_py,residual_angular\n");
}

void LedgerCsv::write(double time, const LedgerInterval& i) {
  file_.write(fmt::format("{:.12g},{},{},{},{},{},{},{},{},{},{},{},{}\n", time, i.reflections,
                          i.kinetic, i.gravity, i.bond, i.drift, i.swing, i.impulse.x, i.impulse.y,
                          i.torque, i.momentum_residual.x, i.momentum_residual.y,
                          i.angular_residual));
}

}  // namespace bounce
