#include "driver/world/files.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "driver/world/input_error.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

std::runtime_error write_error(const fs::path& path) {
  return std::runtime_error(
      fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

}  // namespace

std::string read_text_file(const std::string& path) {
  const auto refuse = [&path] {
    return InputError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) throw refuse();
  std::string text;
  std::array<char, 65536> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    text.append(buffer.data(), got);
  }
  if (std::ferror(file.get()) != 0) throw refuse();
  return text;
}

OutputFile::OutputFile(fs::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) throw write_error(path_);
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) {
    throw write_error(path_);
  }
}

void OutputFile::write_large(fmt::memory_buffer& text) {
  constexpr std::size_t large = std::size_t{1} << 20;  // bytes
  if (text.size() < large) return;
  write({text.data(), text.size()});
  text.clear();
}

void OutputFile::flush() {
  if (std::fflush(file_.get()) != 0) throw write_error(path_);
}

void OutputFile::close() {
  if (file_ && std::fclose(file_.release()) != 0) throw write_error(path_);
}

void check_output_path(const fs::path& path, bool overwrite) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw InputError(fmt::format("{}: is a directory; allowed is a file's name", path.string()));
  }
  if (!overwrite && fs::exists(path, ignored)) {
    throw InputError(fmt::format("{}: exists already; --force overwrites it", path.string()));
  }
  const fs::path folder = fs::absolute(path).parent_path();
  if (!fs::is_directory(folder, ignored) || ::access(folder.c_str(), W_OK) != 0) {
    throw InputError(fmt::format("{}: {} is not a folder that can be written to", path.string(),
                                 folder.string()));
  }
}

void write_file_whole(const fs::path& path, std::string_view text) {
  write_file_whole(path, [text](OutputFile& file) { file.write(text); });
}

void write_file_whole(const fs::path& path, const std::function<void(OutputFile&)>& fill) {
  fs::path temporary = path;
  temporary += fmt::format(".partial-{}", ::getpid());
  try {
    OutputFile file(temporary);
    fill(file);
    file.close();
    fs::rename(temporary, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

}  // namespace bounce
