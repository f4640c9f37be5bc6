#include "driver/world/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <random>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "driver/world/input_error.hpp"
#include "driver/world/limits.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

OutputError write_error(const fs::path& path) {
  return OutputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

// What is to be done at a path.
struct Place {
  enum class Kind { file, stream, standard };
  Kind kind = Kind::file;
  fs::path path{};      // of a file: with no link at its end
  int descriptor = -1;  // of a standard stream
  bool exists = false;
  mode_t mode = 0;        // of a file that exists
  std::string refusal{};  // why nothing is written there, or ""
};

// Where a link that leads to nothing, as yet, would lead.
fs::path follow_links(fs::path path) {
  constexpr int most = 40;  // as the system has it
  std::error_code error;
  for (int i = 0; i < most && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  return path;
}

Place place_of(const fs::path& path) {
  struct stat there {};
  if (::stat(path.c_str(), &there) != 0) {
    if (errno == ENOENT) return {.path = follow_links(path)};
    return {.path = path, .refusal = fmt::format("cannot be written: {}", std::strerror(errno))};
  }
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat ours {};
    if (::fstat(stream, &ours) == 0 && ours.st_dev == there.st_dev && ours.st_ino == there.st_ino) {
      return {.kind = Place::Kind::standard, .path = path, .descriptor = stream, .exists = true};
    }
  }
  const auto refused = [&path](const char* what) {
    return Place{.path = path, .exists = true, .refusal = what};
  };
  switch (there.st_mode & S_IFMT) {
    case S_IFREG: {
      std::error_code error;
      const fs::path real = fs::canonical(path, error);
      return {.path = error ? path : real, .exists = true, .mode = there.st_mode & 0777};
    }
    case S_IFCHR:
    case S_IFIFO:
      return {.kind = Place::Kind::stream, .path = path, .exists = true};
    case S_IFDIR:
      return refused("is a directory; allowed is a file's name");
    case S_IFBLK:
      return refused("is a disk; allowed is a file's name");
    default:
      return refused("is neither file, device nor pipe; allowed is a file's name");
  }
}

// One that takes what is written as it comes.
OutputFile open_stream(const Place& place) {
  std::fflush(place.descriptor == STDOUT_FILENO ? stdout : stderr);  // what is before stays before
  const int descriptor = place.kind == Place::Kind::standard
                             ? ::fcntl(place.descriptor, F_DUPFD_CLOEXEC, 0)
                             : ::open(place.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) throw write_error(place.path);
  return {descriptor, place.path};
}

void replace_file(const Place& place, const std::function<void(OutputFile&)>& fill) {
  int descriptor = -1;
  const fs::path temporary = make_beside(place.path, "partial", [&](const fs::path& name) {
    descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return descriptor >= 0;
  });
  try {
    if (place.exists) static_cast<void>(::fchmod(descriptor, place.mode));  // where there are any
    OutputFile file(descriptor, place.path);
    fill(file);
    file.close();
    if (::rename(temporary.c_str(), place.path.c_str()) != 0) throw write_error(place.path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

// Why a text is not UTF-8 in lines, from its byte `at` on; "" if it is, there.
std::string fault_at(std::string_view text, std::size_t at) {
  if (text[at] == '\0') return "holds a zero byte; allowed is text in UTF-8";
  if (text[at] == '\r' && (at + 1 == text.size() || text[at + 1] != '\n')) {
    return "ends with a carriage return alone; allowed are line feeds, with one before them or not";
  }
  if (utf8_length(text, at) == 0) return "is not UTF-8";
  return "";
}

}  // namespace

std::string read_bytes(const std::string& path) {
  const auto refuse = [&path] {
    return InputError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) throw refuse();
  std::string text;
  std::array<char, 65536> buffer{};
  std::size_t checked = std::size_t{16} << 20;  // below it nobody asks what memory has
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    text.append(buffer.data(), got);
    if (text.size() < checked) continue;
    // A device may have no end. Three times: a copy while the text grows, and what is made of it.
    checked += checked / 4;
    if (!(3.0 * static_cast<double>(checked) <= available_memory())) {
      throw InputError(fmt::format("{}: more than {:.2f} GB, which this process has no memory for",
                                   path, 1e-9 * static_cast<double>(text.size())));
    }
  }
  if (std::ferror(file.get()) != 0) throw refuse();
  return text;
}

std::string read_text_file(const std::string& path) { return text_of(read_bytes(path), path); }

std::string text_of(std::string text, const std::string& name) {
  using namespace std::string_view_literals;
  if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv)) {
    throw InputError(name + ":1: is not UTF-8 but UTF-16; allowed is text in UTF-8");
  }
  if (text.starts_with("\xef\xbb\xbf"sv)) text.erase(0, 3);
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size(); at += utf8_length(text, at)) {
    if (const std::string fault = fault_at(text, at); !fault.empty()) {
      throw InputError(fmt::format("{}:{}: {}", name, line, fault));
    }
    if (text[at] == '\n') ++line;
  }
  return text;
}

std::string fault_of_line(std::string_view line) {
  std::string fault;
  for (std::size_t at = 0; at < line.size() && fault.empty(); at += utf8_length(line, at)) {
    fault = fault_at(line, at);
  }
  return fault;
}

OutputFile::OutputFile(fs::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wbxe")) {
  if (!file_) throw write_error(path_);
}

OutputFile::OutputFile(fs::path path, std::uint64_t size)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "r+be")) {
  if (!file_) throw write_error(path_);
  struct stat there {};
  if (::fstat(::fileno(file_.get()), &there) != 0) throw write_error(path_);
  if (static_cast<std::uint64_t>(there.st_size) < size) {
    throw OutputError(fmt::format("{}: holds {} bytes, and held {} when the checkpoint was written",
                                  path_.string(), there.st_size, size));
  }
  const auto length = static_cast<off_t>(size);
  if (::ftruncate(::fileno(file_.get()), length) != 0 ||
      ::fseeko(file_.get(), length, SEEK_SET) != 0) {
    throw write_error(path_);
  }
}

OutputFile::OutputFile(int descriptor, fs::path path)
    : path_(std::move(path)), file_(::fdopen(descriptor, "wb")) {
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

void OutputFile::sync() {
  flush();
  if (::fdatasync(::fileno(file_.get())) != 0) throw write_error(path_);
}

std::uint64_t OutputFile::size() {
  flush();
  const off_t at = ::ftello(file_.get());
  if (at < 0) throw write_error(path_);
  return static_cast<std::uint64_t>(at);
}

void OutputFile::close() {
  if (file_ && std::fclose(file_.release()) != 0) throw write_error(path_);
}

void check_output_path(const fs::path& path, bool overwrite) {
  const auto refuse = [&path](const std::string& why) {
    throw InputError(fmt::format("{}: {}", path.string(), why));
  };
  const Place place = place_of(path);
  if (!place.refusal.empty()) refuse(place.refusal);
  if (place.kind == Place::Kind::standard) return;
  if (place.exists && ::access(place.path.c_str(), W_OK) != 0) {
    refuse(fmt::format("cannot be written: {}", std::strerror(errno)));
  }
  if (place.kind == Place::Kind::stream) return;
  if (place.exists && !overwrite) refuse("exists already; --force overwrites it");
  std::error_code ignored;
  const fs::path folder = fs::absolute(place.path).parent_path();
  if (!place.path.has_filename() || !fs::is_directory(folder, ignored) ||
      ::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse(fmt::format("{} is not a folder that can be written to", folder.string()));
  }
}

void write_file_whole(const fs::path& path, std::string_view text) {
  write_file_whole(path, [text](OutputFile& file) { file.write(text); });
}

void write_file_whole(const fs::path& path, const std::function<void(OutputFile&)>& fill) {
  const Place place = place_of(path);
  if (!place.refusal.empty()) {
    throw OutputError(fmt::format("{}: {}", path.string(), place.refusal));
  }
  if (place.kind == Place::Kind::file) return replace_file(place, fill);
  OutputFile file = open_stream(place);
  fill(file);
  file.close();
}

void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) throw write_error(folder);
  static_cast<void>(::fsync(descriptor));  // EINVAL where it cannot
  ::close(descriptor);
}

fs::path make_beside(const fs::path& path, std::string_view word,
                     const std::function<bool(const fs::path&)>& make) {
  constexpr int tries = 100;
  constexpr std::size_t longest = 200;  // of 255 bytes that a name may have
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  for (int i = 0; i < tries; ++i) {
    std::string name = path.filename().string().substr(0, longest);
    name += fmt::format(".{}-", word);
    for (int k = 0; k < 6; ++k) name += letters[random() % letters.size()];
    fs::path beside = path.parent_path() / name;
    if (make(beside)) return beside;
    if (errno != EEXIST) break;
  }
  throw write_error(path);
}

}  // namespace bounce
