#include "driver/world/origin.hpp"

#include <chrono>
#include <ctime>
#include <fstream>
#include <thread>

#include <fmt/chrono.h>

#include "driver/world/git_commit.hpp"  // generated at each build by git_commit.cmake

namespace bounce {
namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

Origin find_origin() {
  return {BOUNCE_VERSION,
          git_commit,
          BOUNCE_COMPILER,
          BOUNCE_FLAGS,
          cpu_model(),
          static_cast<int>(std::thread::hardware_concurrency()),
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))};
}

}  // namespace bounce
