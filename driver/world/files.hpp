// Reading and writing files whole, with the reason when it fails.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace bounce {

/// The file's contents. Throws InputError naming the file and the reason.
std::string read_text_file(const std::string& path);

/// A text file being written. Throws std::runtime_error naming file and reason when a write fails,
/// so that a full disk is noticed.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  void write(std::string_view text);
  /// Writes and empties the text if it has become large, so that it need not be held whole.
  void write_large(fmt::memory_buffer& text);
  /// Hands what was written to the operating system.
  void flush();
  /// Flushes and closes; the destructor closes, too, but cannot report an error.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Throws InputError if the file exists and may not be overwritten, or if its folder does not
/// exist.
void check_output_path(const std::filesystem::path& path, bool overwrite);

/// Writes a file under a temporary name and renames it, so that it appears whole.
void write_file_whole(const std::filesystem::path& path, std::string_view text);
/// The same for what `fill` writes into the file.
void write_file_whole(const std::filesystem::path& path,
                      const std::function<void(OutputFile&)>& fill);

}  // namespace bounce
