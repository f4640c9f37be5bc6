#include "driver/output/extended_xyz.hpp"

#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace bounce {

ExtendedXyz::ExtendedXyz(std::filesystem::path path, std::size_t per_ring)
    : path_(std::move(path)), per_ring_(per_ring) {}

ExtendedXyz::ExtendedXyz(const std::filesystem::path& path, std::size_t per_ring,
                         std::uint64_t size)
    : ExtendedXyz(path, per_ring) {
  std::error_code ignored;
  if (size > 0)
    file_.emplace(path_, size);
  else
    std::filesystem::remove(path_, ignored);
}

void ExtendedXyz::write(std::int64_t step, double time, const State& state) {
  if (!file_) file_.emplace(path_);
  fmt::memory_buffer out;
  const auto end = std::back_inserter(out);
  // Species X: no chemical element, in ASE's table too.
  fmt::format_to(end,
                 "{}\nProperties=species:S:1:pos:R:3:velo:R:3:ring:I:1 Time={:.12g} Step={} "
                 "pbc=\"F F F\"\n",
                 state.size(), time, step);
  for (std::size_t i = 0; i < state.size(); ++i) {
    fmt::format_to(end, "X {} {} 0.0 {} {} 0.0 {}\n", state.x[i], state.y[i], state.vx[i],
                   state.vy[i], i / per_ring_ + 1);
    file_->write_large(out);
  }
  file_->write({out.data(), out.size()});
  file_->flush();
}

void ExtendedXyz::close() {
  if (file_) file_->close();
}

}  // namespace bounce
