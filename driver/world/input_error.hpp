// What the user gave and we cannot use, in words that can be read whatever it was.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace bounce {

/// A text as a message shows it, on one line: line ends, control characters and bytes that are not
/// UTF-8 as \n, \x00 and the like, more than 40 digits in a row cut short,
/// plain_nan().
std::string printable(std::string_view text);

/// A text in which what is no number stands as "nan", whichever sign its bits have.
std::string plain_nan(std::string text);

/// Length of the UTF-8 character that begins at `at`, 1 to 4 bytes; 0 if there is none.
std::size_t utf8_length(std::string_view text, std::size_t at);

/// Bad input: one message that names file, line, key or option, what stands there and what is
/// allowed. main() prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::string_view message) : std::runtime_error(printable(message)) {}
};

}  // namespace bounce
