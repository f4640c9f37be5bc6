#include "driver/output/monitor_csv.hpp"

#include <fmt/format.h>

namespace bounce {

MonitorCsv::MonitorCsv(const std::filesystem::path& path) : file_(path) {
  file_.write(
      "t,kinetic,bond,gravity,total,px,py,angular_momentum,cx,cy,lowest,smallest_ratio,on_wall,"
      "walls,drift,impulse_x,impulse_y,stable_part\n");
}

void MonitorCsv::write(double time, const Sample& now, const LedgerInterval& interval,
                       double stable_part) {
  if (!started_) start_ = now;
  started_ = true;
  walls_.add(interval.walls);
  drift_.add(interval.drift);
  impulse_x_.add(interval.impulse.x);
  impulse_y_.add(interval.impulse.y);
  file_.write(fmt::format("{:.12g},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.6g}\n", time,
                          now.kinetic - start_.kinetic, now.bond - start_.bond,
                          now.gravity - start_.gravity, now.total() - start_.total(),
                          now.momentum.x, now.momentum.y, now.angular_momentum, now.centre.x,
                          now.centre.y, now.lowest, now.smallest_ratio, now.on_wall, walls_.value(),
                          drift_.value(), impulse_x_.value(), impulse_y_.value(), stable_part));
}

}  // namespace bounce
