// Where a result comes from: program, compiler, machine, date.
#pragma once

#include <string>

namespace bounce {

struct Origin {
  std::string version;
  std::string commit;  ///< with "-dirty" if the tree had changes when it was built; or "unknown"
  std::string compiler;
  std::string flags;
  std::string cpu;   ///< model name
  int cores = 0;     ///< hardware threads
  std::string date;  ///< now, UTC, ISO 8601
};

Origin find_origin();

}  // namespace bounce
