// A run's directory: filled under the name NAME.part beside its place, and renamed when it is
// whole. What a stopped run has left there can be gone on with if it holds a checkpoint.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace bounce {

/// Folders made for an output, removed again where nothing has come into them.
class MadeFolders {
 public:
  MadeFolders() = default;
  ~MadeFolders();
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;
  /// Makes `folder` and those above it. Throws std::system_error.
  void make(const std::filesystem::path& folder);

 private:
  std::vector<std::filesystem::path> made_;  // the outermost first
};

/// Keeps a directory for one process: a second one that asks for it is refused. The lock is the
/// system's on the file .NAME.bounce-lock beside the directory; it ends with the process, however
/// that ends, and what may be left is an empty file that locks nothing.
class OutputLock {
 public:
  /// Throws InputError if another process has it. Where the file system knows no locks there is
  /// none. `asked`: what messages call the directory.
  OutputLock(const std::filesystem::path& directory, const std::string& asked);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// The directory of one run. While it is filled its name is NAME.part. Removed again if it is
/// neither published nor to be kept, so that an error leaves nothing.
class RunDirectory {
 public:
  /// To be made before the work begins. Throws InputError if `target` exists and may not be
  /// replaced, or holds no run and would be lost, if another process is at work for it, if
  /// NAME.part is a stopped run that can be gone on with (`replace` drops it) or is no run, or if a
  /// directory cannot be made there.
  /// `marker`: the file by which a directory that may be replaced is known.
  RunDirectory(const std::filesystem::path& target, bool replace, std::string marker = "run.json");
  /// Goes on in the directory of a stopped run: NAME.part if there is one that can be gone on with,
  /// else NAME itself. `target` may be either name. Throws InputError if there is nothing to go on
  /// with, or another process does.
  static RunDirectory reopen(const std::filesystem::path& target);
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Where to write for now.
  [[nodiscard]] const std::filesystem::path& path() const { return part_; }
  /// Its name in the end, as it was asked for.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// From now on what is there stays, whatever happens.
  void keep() { keep_ = true; }
  [[nodiscard]] bool is_kept() const { return keep_; }
  /// Renames it into its place. Throws OutputError naming where the files are if that fails.
  void publish();

 private:
  struct Reopened {};
  RunDirectory(Reopened, const std::filesystem::path& target);
  void take_part();

  std::string name_;
  std::filesystem::path target_, part_;
  bool replace_;
  std::string marker_;
  bool keep_ = false;
  MadeFolders parents_;
  std::unique_ptr<OutputLock> lock_;
};

/// Throws InputError if `target` exists and may not be replaced: without `replace` anything, with
/// it all but empty directories and those that hold the file `marker`. A link is not followed.
void check_run_directory(const std::filesystem::path& target, bool replace,
                         const std::string& marker = "run.json");

/// The file by which a run can be gone on with, in its directory (driver/run/checkpoint.hpp).
inline constexpr const char* checkpoint_name = "checkpoint";

/// Gives the directory `from` the name `to`; what stood there, which must be a directory, is
/// removed once the new one has its place.
void put_in_place(const std::filesystem::path& from, const std::filesystem::path& to);

/// Absolute, without "." and a slash at the end, so that a name can be added to it.
std::filesystem::path plain_path(const std::filesystem::path& path);

}  // namespace bounce
