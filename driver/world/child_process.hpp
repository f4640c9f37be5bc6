// Another run of this program, as a process of its own: whatever happens to it, this one goes on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bounce {

/// How a process ended.
struct ProcessEnd {
  int exit_code = 0;       ///< if it exited
  int signal = 0;          ///< that ended it, or 0
  bool timed_out = false;  ///< it was killed by us after its time
  [[nodiscard]] bool exited() const { return signal == 0 && !timed_out; }
};

/// Runs this very program with these arguments in `folder`, its output in the files `out` and `err`
/// there, and waits for it, at most `seconds`; asks it to end once
/// interrupted(). Throws std::runtime_error if it cannot be started.
/// May be called from several threads.
ProcessEnd run_this_program(const std::vector<std::string>& arguments,
                            const std::filesystem::path& folder, const std::string& out,
                            const std::string& err, double seconds);

}  // namespace bounce
