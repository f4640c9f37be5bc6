// Reading and writing files whole, with the reason when it fails.
//
// What stands at a path that is to be written decides what happens, here for all commands:
//   nothing, a file   a new file takes its place whole: it is filled under a temporary name that is
//                     made new beside it, then renamed; permissions are kept
//   a link            stays; what it leads to is written by these same rules, made if need be
//   a device, a pipe  stays and is written into, as the shell's > does
//   standard output or error, by whatever name: is written into where it stands
//   a directory, a disk, a socket: refused
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace bounce {

/// The file's bytes. Throws InputError naming the file and the reason.
std::string read_bytes(const std::string& path);

/// The text of a file in UTF-8, without the mark that may stand before it (BOM). Throws InputError
/// naming file and line where it is no such text: UTF-16, another encoding, a zero byte, lines that
/// end with a carriage return alone.
std::string read_text_file(const std::string& path);
/// The same of bytes that are there already; messages call them `name`.
std::string text_of(std::string bytes, const std::string& name);
/// Why a line is not UTF-8, to stand behind its name; "" if it is.
std::string fault_of_line(std::string_view line);

/// What was asked for cannot be written; the message names file and reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file being written. Throws OutputError when a write fails, so that a full disk is noticed.
class OutputFile {
 public:
  /// A new file: one that exists is an error.
  explicit OutputFile(std::filesystem::path path);
  /// A file that exists, from its byte `size` on; what it has beyond is cut off. Throws OutputError
  /// if it is shorter.
  OutputFile(std::filesystem::path path, std::uint64_t size);
  /// Takes over an open file.
  OutputFile(int descriptor, std::filesystem::path path);
  void write(std::string_view text);
  /// Writes and empties the text if it has become large, so that it need not be held whole.
  void write_large(fmt::memory_buffer& text);
  /// Hands what was written to the operating system.
  void flush();
  /// Flushes, and returns once it is on the disk.
  void sync();
  /// Bytes so far. Flushes.
  [[nodiscard]] std::uint64_t size();
  /// Flushes and closes; the destructor closes, too, but cannot report an error.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// To be called before the work begins: throws InputError if write_file_whole() would refuse the
/// path, if a file exists there and may not be overwritten, or if its folder does not exist or
/// cannot be written to.
void check_output_path(const std::filesystem::path& path, bool overwrite);

/// Writes what a user asked for at that path, by the rules above.
void write_file_whole(const std::filesystem::path& path, std::string_view text);
/// The same for what `fill` writes into the file.
void write_file_whole(const std::filesystem::path& path,
                      const std::function<void(OutputFile&)>& fill);

/// Returns once the folder's names are on the disk, where the file system can do that.
void sync_folder(const std::filesystem::path& folder);

/// Calls `make` with names beside `path`, PATH.WORD-XXXXXX, until it makes one that is new; it
/// returns false and sets errno otherwise. Throws OutputError if nothing can be made there.
std::filesystem::path make_beside(const std::filesystem::path& path, std::string_view word,
                                  const std::function<bool(const std::filesystem::path&)>& make);

}  // namespace bounce
