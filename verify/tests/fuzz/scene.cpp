// Scene files.
#include "driver/world/files.hpp"
#include "verify/tests/fuzz/fuzzed_scene.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return bounce::fuzz(data, size, [](std::string bytes) {
    bounce::use_scene(
        bounce::SceneFile::parse(bounce::text_of(std::move(bytes), "input"), "input"));
  });
}
