#include "driver/world/run_directory.hpp"

#include <unistd.h>

#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "driver/world/input_error.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

// Absolute, without "." and a slash at the end, so that a name can be added to it.
fs::path plain(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

fs::path beside(const fs::path& path, const char* word) {
  fs::path other = path;
  other += fmt::format(".{}-{}", word, ::getpid());
  return other;
}

}  // namespace

void check_run_directory(const fs::path& target, bool replace, const std::string& marker) {
  const fs::path path = plain(target);
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(path, ignored))) return;
  if (!replace) {
    throw InputError(fmt::format("--out {}: exists already; --force replaces it", target.string()));
  }
  const bool holds_a_run = fs::exists(path / marker, ignored);
  const bool is_empty = fs::is_directory(path, ignored) && fs::is_empty(path, ignored);
  if (fs::is_symlink(path, ignored) || !(holds_a_run || is_empty)) {
    throw InputError(fmt::format(
        "--out {}: is not the directory of a run (no {} there); --force replaces nothing else",
        target.string(), marker));
  }
}

RunDirectory::RunDirectory(const fs::path& target, bool replace, std::string marker)
    : target_(plain(target)),
      partial_(beside(target_, "partial")),
      replace_(replace),
      marker_(std::move(marker)) {
  check_run_directory(target, replace, marker_);
  std::error_code error;
  fs::create_directories(target_.parent_path(), error);
  if (!error) fs::create_directory(partial_, error);
  if (error) {
    throw InputError(fmt::format("--out {}: a directory cannot be made there: {}", target.string(),
                                 error.message()));
  }
}

RunDirectory::~RunDirectory() {
  if (keep_) return;
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
}

void RunDirectory::publish() {
  keep_ = true;  // from here on the run is worth more than a tidy disk
  const fs::path old = beside(target_, "old");
  try {
    check_run_directory(target_, replace_, marker_);  // it may have appeared meanwhile
    const bool had_old = fs::exists(target_);
    if (had_old) fs::rename(target_, old);
    fs::rename(partial_, target_);
    if (had_old) fs::remove_all(old);
  } catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("{}\nthe run's files are in {}", error.what(), partial_.string()));
  }
}

}  // namespace bounce
