#include "driver/world/console.hpp"

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigaction() is POSIX
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "driver/world/input_error.hpp"

namespace bounce {
namespace {

int first_error = 0;  // errno of the first write on standard output that failed

void note_error() {
  if (first_error == 0) first_error = errno == 0 ? EIO : errno;
}

// Opens the number, if it is closed, in such a way that using it fails, or is lost.
void keep_open(int stream, int flags) {
  if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) return;
  const int opened = ::open("/dev/null", flags);
  if (opened == stream || opened < 0) return;
  ::dup2(opened, stream);
  ::close(opened);
}

}  // namespace

void guard_streams() {
  keep_open(STDIN_FILENO, O_WRONLY);
  keep_open(STDOUT_FILENO, O_RDONLY);
  keep_open(STDERR_FILENO, O_WRONLY);
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow fails as a full disk does
}

void write_out(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) note_error();
}

void write_err(std::string_view text) {
  const std::string readable = plain_nan(std::string(text));
  static_cast<void>(std::fwrite(readable.data(), 1, readable.size(), stderr));
}

void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0) note_error();
}

int finish_output(int exit_code) {
  flush_output();
  if (first_error == 0) return exit_code;
  if (first_error == EPIPE) return exit_code == 0 ? 128 + SIGPIPE : exit_code;
  print_err("bounce: standard output cannot be written: {}\n", std::strerror(first_error));
  return exit_code == 0 ? 1 : exit_code;
}

}  // namespace bounce
