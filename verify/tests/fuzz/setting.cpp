// What stands behind --set, one a line, on the scene with two walls.
#include <sstream>

#include "verify/tests/fuzz/fuzzed_scene.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return bounce::fuzz(data, size, [](const std::string& bytes) {
    static const bounce::SceneFile start = bounce::SceneFile::find("example-7");
    bounce::SceneFile file = start;
    std::istringstream lines(bytes);
    for (std::string line; std::getline(lines, line);) file.set(line);
    bounce::use_scene(file);
  });
}
