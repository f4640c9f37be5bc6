// What the program prints. A write that fails is remembered, not thrown, so that it stops no work;
// main() asks at the end, for every command.
#pragma once

#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace bounce {

/// To be called first: a stream that is closed must not become the number of a file that is opened
/// later, and a reader that has gone must not end a run that writes files.
void guard_streams();

/// Prints on standard output.
void write_out(std::string_view text);
template <class... Values>
void print_out(fmt::format_string<Values...> format, Values&&... values) {
  write_out(fmt::format(format, std::forward<Values>(values)...));
}

/// Prints on standard error; what cannot be printed there is lost.
void write_err(std::string_view text);
template <class... Values>
void print_err(fmt::format_string<Values...> format, Values&&... values) {
  write_err(fmt::format(format, std::forward<Values>(values)...));
}

/// Hands what was printed to whoever reads it.
void flush_output();

/// The program's exit code, once all is printed. Where something could not be, one message on
/// standard error says why and 0 becomes 1; of a reader that has gone (`| head`) nothing is said,
/// and 0 becomes 141, 128 + SIGPIPE.
int finish_output(int exit_code);

}  // namespace bounce
