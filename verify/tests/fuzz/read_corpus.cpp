// Without libFuzzer: a fuzz target reads every file of the folders named, once.
//     fuzz_TARGET FOLDER...
#include <cstdio>
#include <filesystem>
#include <string>

#include "driver/world/files.hpp"
#include "verify/tests/fuzz/fuzz_target.hpp"

int main(int count, char** arguments) {
  int files = 0;
  for (int i = 1; i < count; ++i) {
    for (const auto& entry : std::filesystem::directory_iterator(arguments[i])) {
      std::printf("%s\n", entry.path().c_str());
      std::fflush(stdout);
      const std::string bytes = bounce::read_bytes(entry.path());
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
      ++files;
    }
  }
  return files > 0 ? 0 : 1;
}
