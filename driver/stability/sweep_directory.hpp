// The directory of a sweep that may be stopped and gone on with.
//
// While it is measured, what is known stands in DIR.part: `arguments.json`, what was asked, and
// `rows.csv`, to which each row is added once it is measured. At the end edge.csv is written there,
// in the order of the cases, and the folder gets its name. Asked the same again, a sweep goes on
// from the rows it finds; the end of one that was being written when it was killed is cut off.
#pragma once

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "driver/world/run_directory.hpp"

namespace bounce {

class SweepDirectory {
 public:
  /// The file by which the directory of a sweep is known.
  static constexpr const char* marker = "edge.csv";

  /// Throws InputError if `target` exists and may not be replaced or holds no sweep, if DIR.part is
  /// of a sweep with other arguments (`replace` drops it), or if another process works there.
  SweepDirectory(const std::filesystem::path& target, bool replace, const std::string& arguments);
  ~SweepDirectory();
  SweepDirectory(const SweepDirectory&) = delete;
  SweepDirectory& operator=(const SweepDirectory&) = delete;

  /// Rows found, by key: the line without its end.
  [[nodiscard]] const std::map<std::string, std::string>& found() const { return found_; }
  /// Adds a row; it is on its way to the disk when this returns.
  void add(const std::string& line);
  /// Where to write what else belongs there.
  [[nodiscard]] const std::filesystem::path& path() const { return part_; }
  /// Gives the folder its name, without rows.csv and arguments.json.
  void publish();

 private:
  void check_part() const;
  void open_rows(const std::string& arguments, bool replace);
  void read_rows();
  std::filesystem::path target_, part_;
  bool replace_;
  std::FILE* rows_ = nullptr;
  std::map<std::string, std::string> found_;
  MadeFolders parents_;
  std::unique_ptr<OutputLock> lock_;
};

}  // namespace bounce
