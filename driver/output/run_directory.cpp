#include "driver/output/run_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

fs::path make_directory_beside(const fs::path& path, std::string_view word) {
  return make_beside(path, word,
                     [](const fs::path& name) { return ::mkdir(name.c_str(), 0777) == 0; });
}

// The file at the path is still the open one: whoever had the lock before may have removed it.
bool is_still(int descriptor, const fs::path& path) {
  struct stat open {};
  struct stat there {};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &there) == 0 &&
         open.st_dev == there.st_dev && open.st_ino == there.st_ino;
}

// Why the directory must not be replaced; "" if it may.
std::string refusal_of(const fs::path& path, const std::string& marker) {
  std::error_code ignored;
  if (fs::is_symlink(fs::symlink_status(path, ignored))) {
    return "is a link; allowed is what it leads to, or another name";
  }
  if (!fs::is_directory(path, ignored)) return "is not the directory of a run: it is no directory";
  if (fs::exists(path / marker, ignored) || fs::is_empty(path, ignored)) return "";
  return fmt::format("is not the directory of a run (no {} there)", marker);
}

constexpr const char* part_suffix = ".part";

fs::path part_of(fs::path target) { return target += part_suffix; }

bool has_checkpoint(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / checkpoint_name, ignored);
}

// As it was asked for, without a slash at its end.
std::string name_of(const fs::path& target) {
  return (target.has_filename() ? target : target.parent_path()).string();
}

// What a run that was killed may leave: the directory has a scene, or nothing yet but that in the
// making.
bool is_left_over(const fs::path& part) {
  if (!fs::is_directory(fs::symlink_status(part))) return false;
  constexpr std::string_view scene = "scene.toml";
  if (fs::exists(part / scene)) return true;
  for (const auto& entry : fs::directory_iterator(part)) {
    if (!entry.path().filename().string().starts_with(scene)) return false;
  }
  return true;
}

// Files that were being written when the run was killed (make_beside() in files.hpp).
void remove_temporaries(const fs::path& folder) {
  constexpr std::string_view word = ".partial-";
  constexpr std::size_t letters = 6;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.size() < word.size() + letters) continue;
    if (name.substr(name.size() - word.size() - letters).starts_with(word)) found.push_back(entry);
  }
  for (const fs::path& file : found) fs::remove(file);
}

}  // namespace

fs::path plain_path(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

MadeFolders::~MadeFolders() {
  // (No std::views: clang 14, which builds the fuzz targets, cannot read those of GCC 12.)
  while (!made_.empty() && ::rmdir(made_.back().c_str()) == 0) made_.pop_back();
}

void MadeFolders::make(const fs::path& folder) {
  if (fs::is_directory(folder)) return;
  if (folder.has_parent_path() && folder.parent_path() != folder) make(folder.parent_path());
  if (::mkdir(folder.c_str(), 0777) == 0) {
    made_.push_back(folder);
  } else if (!fs::is_directory(folder)) {
    const int why = errno == EEXIST ? ENOTDIR : errno;
    throw std::system_error(why, std::generic_category(), folder.string());
  }
}

OutputLock::OutputLock(const fs::path& directory, const std::string& asked)
    : path_(directory.parent_path() /
            fmt::format(".{}.bounce-lock", directory.filename().string())) {
  for (;;) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0) return;
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const bool taken = errno == EWOULDBLOCK;
      ::close(std::exchange(descriptor_, -1));
      if (!taken) return;
      throw InputError(fmt::format(
          "--out {}: another bounce is at work for this directory; allowed is another name",
          asked));
    }
    if (is_still(descriptor_, path_)) return;
    ::close(std::exchange(descriptor_, -1));
  }
}

OutputLock::~OutputLock() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());  // before the lock goes: then it is nobody else's
  ::close(descriptor_);
}

void check_run_directory(const fs::path& target, bool replace, const std::string& marker) {
  const fs::path path = plain_path(target);
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(path, ignored))) return;
  const std::string refusal = refusal_of(path, marker);
  if (replace && refusal.empty()) return;
  throw InputError(fmt::format(
      "--out {}: {}", target.string(),
      !replace ? "exists already" + (refusal.empty() ? "; --force replaces it" : " and " + refusal)
               : refusal + "; --force replaces nothing else"));
}

RunDirectory::RunDirectory(const fs::path& target, bool replace, std::string marker)
    : name_(name_of(target)),
      target_(plain_path(target)),
      part_(part_of(target_)),
      replace_(replace),
      marker_(std::move(marker)) {
  check_run_directory(target, replace, marker_);
  try {
    parents_.make(target_.parent_path());
    lock_ = std::make_unique<OutputLock>(target_, target.string());
    check_run_directory(target, replace, marker_);  // one may just have been published there
    take_part();
  } catch (const std::system_error& error) {
    throw InputError(fmt::format("--out {}: a directory cannot be made there: {}", target.string(),
                                 error.code().message()));
  }
}

RunDirectory::RunDirectory(Reopened, const fs::path& target)
    : name_(name_of(target)),
      target_(plain_path(target)),
      part_(part_of(target_)),
      replace_(true),
      marker_("run.json") {
  lock_ = std::make_unique<OutputLock>(target_, name_);
  if (!has_checkpoint(part_)) part_ = target_;
  if (!has_checkpoint(part_)) {
    throw InputError(fmt::format(
        "{}: there is no run to go on with; allowed is what bounce run was given as --out, where "
        "it left a checkpoint",
        name_));
  }
  keep_ = true;
  remove_temporaries(part_);
}

RunDirectory RunDirectory::reopen(const fs::path& target) {
  const fs::path name = name_of(target);
  return {Reopened{}, name.extension() == part_suffix ? fs::path(name).replace_extension() : name};
}

// Makes NAME.part, or what is left there of a run that cannot be gone on with an empty one.
void RunDirectory::take_part() {
  if (::mkdir(part_.c_str(), 0777) == 0) return;
  if (errno != EEXIST) throw std::system_error(errno, std::generic_category(), part_.string());
  if (!is_left_over(part_)) {
    throw InputError(
        fmt::format("--out {}: {}{} is there, and is no stopped run", name_, name_, part_suffix));
  }
  if (has_checkpoint(part_) && !replace_) {
    throw InputError(fmt::format(
        "--out {0}: a run for it was stopped ({0}{1}); \"bounce resume {0}\" goes on with it, "
        "--force drops it",
        name_, part_suffix));
  }
  for (const auto& entry : fs::directory_iterator(part_)) fs::remove_all(entry.path());
}

RunDirectory::~RunDirectory() {
  if (keep_ || !lock_) return;
  std::error_code ignored;
  fs::remove_all(part_, ignored);
}

void RunDirectory::publish() {
  keep_ = true;  // from here on the run is worth more than a tidy disk
  if (part_ == target_) return;
  try {
    check_run_directory(target_, replace_, marker_);  // it may have appeared meanwhile
    // What is replaced is no run to go on with, should this be its end.
    fs::remove(target_ / checkpoint_name);
    put_in_place(part_, target_);
  } catch (const std::exception& error) {
    throw OutputError(fmt::format("{}\nthe run's files are in {}", error.what(), part_.string()));
  }
}

void put_in_place(const fs::path& from, const fs::path& to) {
  std::error_code ignored;  // what is left of the old one is in nobody's way
  if (!fs::exists(to)) return fs::rename(from, to);
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) {
    fs::remove_all(from, ignored);
    return;
  }
  // A file system that cannot exchange two names.
  const fs::path old = make_directory_beside(to, "old");
  fs::rename(to, old);
  fs::rename(from, to);
  fs::remove_all(old, ignored);
}

}  // namespace bounce
