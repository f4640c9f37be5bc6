// What the user gave and we cannot use.
#pragma once

#include <stdexcept>

namespace bounce {

/// Bad input: one message that names file, line, key or option, what stands there and what is
/// allowed. main() prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bounce
