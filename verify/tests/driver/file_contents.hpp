// A file's bytes.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace bounce {

namespace fs = std::filesystem;

inline std::string contents(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The first line in which two texts differ, for the message of a failure.
inline std::string where_they_differ(const std::string& a, const std::string& b) {
  std::istringstream one(a), other(b);
  std::string line, theirs;
  for (int number = 1;; ++number) {
    const bool more = static_cast<bool>(std::getline(one, line));
    const bool more_theirs = static_cast<bool>(std::getline(other, theirs));
    if (!more && !more_theirs) return "nowhere but in the end of the last line";
    if (more && more_theirs && line == theirs) continue;
    const std::string none = "nothing";
    return "line " + std::to_string(number) + ": " + (more ? line : none) + "\n and " +
           (more_theirs ? theirs : none);
  }
}

}  // namespace bounce
