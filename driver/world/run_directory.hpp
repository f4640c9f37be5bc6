// A run's directory: filled under a temporary name beside its place, and renamed when it is whole.
#pragma once

#include <filesystem>
#include <string>

namespace bounce {

/// The directory of one run. Removed again if it is not published, so that an error leaves nothing.
class RunDirectory {
 public:
  /// Throws InputError if `target` exists and may not be replaced, or holds no run and would be
  /// lost, or if a directory cannot be made beside it.
  /// `marker`: the file by which a directory that may be replaced is known.
  RunDirectory(const std::filesystem::path& target, bool replace, std::string marker = "run.json");
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Where to write for now.
  [[nodiscard]] const std::filesystem::path& path() const { return partial_; }
  /// Renames it into its place. Throws std::runtime_error naming where the files are if that fails.
  void publish();

 private:
  std::filesystem::path target_, partial_;
  bool replace_;
  std::string marker_;
  bool keep_ = false;
};

/// The checks of RunDirectory's constructor alone, to be made before a long preparation.
void check_run_directory(const std::filesystem::path& target, bool replace,
                         const std::string& marker = "run.json");

}  // namespace bounce
