// frames.extxyz: the ball at the scene's times, for OVITO, ASE and the figures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "driver/world/files.hpp"
#include "kernels/model/state.hpp"

namespace bounce {

/// Extended XYZ: a frame is the number of particles, a line of properties, and a line a particle
/// with species, position (cm, z = 0), velocity (cm/s) and ring (from 1; of a ball without rings
/// per_ring is all its particles, and the ring 1).
class ExtendedXyz {
 public:
  ExtendedXyz(std::filesystem::path path, std::size_t per_ring);
  /// Goes on with a file of which `size` bytes count; 0: there is none yet.
  ExtendedXyz(const std::filesystem::path& path, std::size_t per_ring, std::uint64_t size);
  void write(std::int64_t step, double time, const State& state);
  void close();
  /// Null before the first frame.
  [[nodiscard]] OutputFile* file() { return file_ ? &*file_ : nullptr; }

 private:
  std::filesystem::path path_;
  std::optional<OutputFile> file_;  // opened by the first frame: readers refuse an empty file
  std::size_t per_ring_;
};

}  // namespace bounce
