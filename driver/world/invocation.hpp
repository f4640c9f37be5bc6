// What was asked of the program, and where.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bounce {

struct Invocation {
  std::vector<std::string> arguments;  ///< of the command line, without the program
  std::filesystem::path folder;        ///< in which it ran
};

}  // namespace bounce
