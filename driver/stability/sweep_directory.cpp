#include "driver/stability/sweep_directory.hpp"

#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "driver/stability/edge_row.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

// Without a slash at the end, so that a name can be added to it.
fs::path plain(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

void check_target(const fs::path& target, bool replace) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(target, ignored))) return;
  if (!replace) {
    throw InputError(fmt::format("--out {}: exists already; --force replaces it", target.string()));
  }
  const bool ours = fs::exists(target / "edge.csv", ignored) && !fs::is_symlink(target, ignored);
  if (!ours) {
    throw InputError(
        fmt::format("--out {}: is not the directory of a sweep; --force replaces nothing else",
                    target.string()));
  }
}

std::string key_of(const std::string& line) {
  std::size_t at = 0;
  for (std::size_t column = 0; column < edge_key_columns; ++column) at = line.find(',', at) + 1;
  return line.substr(0, at - 1);
}

}  // namespace

SweepDirectory::SweepDirectory(fs::path target, bool replace, const std::string& arguments)
    : target_(plain(target)), part_(target_), replace_(replace) {
  part_ += ".part";
  check_target(target_, replace);
  std::error_code error;
  fs::create_directories(part_, error);
  if (error) {
    throw InputError(fmt::format("--out {}: a directory cannot be made there: {}", target_.string(),
                                 error.message()));
  }
  open_rows(arguments, replace);
  read_rows();
}

SweepDirectory::~SweepDirectory() {
  if (rows_ != nullptr) std::fclose(rows_);
}

void SweepDirectory::open_rows(const std::string& arguments, bool replace) {
  const fs::path rows = part_ / "rows.csv";
  rows_ = std::fopen(rows.c_str(), "ab");
  if (rows_ == nullptr) {
    throw InputError(fmt::format("{}: cannot be written: {}", rows.string(), std::strerror(errno)));
  }
  if (::flock(::fileno(rows_), LOCK_EX | LOCK_NB) != 0) {
    throw InputError(
        fmt::format("--out {}: another bounce stability is at work there", target_.string()));
  }
  const fs::path asked = part_ / "arguments.json";
  if (fs::exists(asked) && read_text_file(asked.string()) != arguments) {
    if (!replace) {
      throw InputError(
          fmt::format("--out {}: a sweep with other arguments, or of another build, was stopped "
                      "there ({}); --force drops it",
                      target_.string(), asked.string()));
    }
    fs::resize_file(rows, 0);
  }
  write_file_whole(asked, arguments);
}

void SweepDirectory::read_rows() {
  const fs::path rows = part_ / "rows.csv";
  const std::string text = read_text_file(rows.string());
  std::size_t from = 0;
  for (;;) {
    const std::size_t end = text.find('\n', from);
    if (end == std::string::npos) break;
    const std::string line = text.substr(from, end - from);
    if (!read_edge_line(line)) break;
    found_[key_of(line)] = line;
    from = end + 1;
  }
  if (from < text.size()) fs::resize_file(rows, from);  // from where it is torn
}

void SweepDirectory::add(const std::string& line) {
  if (std::fputs((line + "\n").c_str(), rows_) < 0 || std::fflush(rows_) != 0) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", (part_ / "rows.csv").string(),
                                         std::strerror(errno)));
  }
}

void SweepDirectory::publish() {
  check_target(target_, replace_);  // it may have appeared meanwhile
  fs::remove_all(target_);
  fs::rename(part_, target_);
  fs::remove(target_ / "rows.csv");
  fs::remove(target_ / "arguments.json");
}

}  // namespace bounce
