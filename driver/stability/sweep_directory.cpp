#include "driver/stability/sweep_directory.hpp"

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

std::string key_of(const std::string& line) {
  std::size_t at = 0;
  for (std::size_t column = 0; column < edge_key_columns; ++column) at = line.find(',', at) + 1;
  return line.substr(0, at - 1);
}

}  // namespace

SweepDirectory::SweepDirectory(const fs::path& target, bool replace, const std::string& arguments)
    : target_(plain_path(target)), part_(target_), replace_(replace) {
  part_ += ".part";
  check_run_directory(target, replace, marker);
  try {
    parents_.make(target_.parent_path());
    lock_ = std::make_unique<OutputLock>(target_, target.string());
    check_run_directory(target, replace, marker);  // one may just have been published there
    check_part();
    fs::create_directory(part_);
  } catch (const std::system_error& error) {
    throw InputError(fmt::format("--out {}: a directory cannot be made there: {}", target.string(),
                                 error.code().message()));
  }
  open_rows(arguments, replace);
  read_rows();
}

SweepDirectory::~SweepDirectory() {
  if (rows_ != nullptr) std::fclose(rows_);
}

// What is not a stopped sweep's is not gone on with.
void SweepDirectory::check_part() const {
  if (!fs::exists(fs::symlink_status(part_))) return;
  const bool ours = fs::is_directory(fs::symlink_status(part_)) &&
                    (fs::is_empty(part_) || fs::exists(part_ / "rows.csv"));
  if (ours) return;
  throw InputError(fmt::format("--out {}: {} is there, and is no stopped sweep's", target_.string(),
                               part_.string()));
}

void SweepDirectory::open_rows(const std::string& arguments, bool replace) {
  const fs::path rows = part_ / "rows.csv";
  rows_ = std::fopen(rows.c_str(), "ab");
  if (rows_ == nullptr) {
    throw InputError(fmt::format("{}: cannot be written: {}", rows.string(), std::strerror(errno)));
  }
  const fs::path asked = part_ / "arguments.json";
  if (fs::exists(asked) && read_bytes(asked.string()) != arguments) {
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
  const std::string text = read_bytes(rows.string());  // whatever a crash left
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
  check_run_directory(target_, replace_, marker);  // it may have appeared meanwhile
  put_in_place(part_, target_);
  fs::remove(target_ / "rows.csv");
  fs::remove(target_ / "arguments.json");
}

}  // namespace bounce
