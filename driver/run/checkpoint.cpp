#include "driver/run/checkpoint.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/output/run_directory.hpp"
#include "driver/scene/scene_file.hpp"
#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/origin.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int format = 1;
constexpr std::string_view first_words = "bounce checkpoint ";
constexpr const char* before_name = "checkpoint.before";

std::vector<std::uint64_t> words_of(std::string_view bytes) {
  std::vector<std::uint64_t> words(bytes.size() / 8);
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), 8 * words.size());
  return words;
}

std::string_view bytes_of(std::span<const std::uint64_t> words) {
  return {reinterpret_cast<const char*>(words.data()), 8 * words.size()};
}

std::string hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

std::string head_text(const CheckpointHead& head) {
  const RunSettings& s = head.settings;
  const Json json{{"version", head.version},
                  {"commit", head.commit},
                  {"step", head.step},
                  {"time", head.time},
                  {"scene_hash", hex(head.scene)},
                  {"start_hash", hex(head.start)},
                  {"command", s.command},
                  {"scene", s.scene_name},
                  {"initial", s.initial},
                  {"advice", s.advice},
                  {"kernel", s.request.kernel},
                  {"vector", s.request.vector},
                  {"threads", s.request.threads},
                  {"final_state", s.final_state},
                  {"listing_frames", s.listing_frames},
                  {"ledger", s.ledger},
                  {"quiet", s.quiet},
                  {"resumed", s.resumed}};
  std::string text = fmt::format("{}{}\n{}", first_words, format,
                                 json.dump(-1, ' ', false, Json::error_handler_t::replace));
  text.append((8 - (text.size() + 1) % 8) % 8, ' ');
  return text + "\n";
}

CheckpointHead read_head(std::string_view text) {
  const Json json = Json::parse(text);
  CheckpointHead head;
  const auto read_hex = [&json](const char* key) {
    return std::stoull(json.at(key).get<std::string>(), nullptr, 16);
  };
  json.at("version").get_to(head.version);
  json.at("commit").get_to(head.commit);
  json.at("step").get_to(head.step);
  json.at("time").get_to(head.time);
  head.scene = read_hex("scene_hash");
  head.start = read_hex("start_hash");
  RunSettings& s = head.settings;
  json.at("command").get_to(s.command);
  json.at("scene").get_to(s.scene_name);
  json.at("initial").get_to(s.initial);
  json.at("advice").get_to(s.advice);
  json.at("kernel").get_to(s.request.kernel);
  json.at("vector").get_to(s.request.vector);
  json.at("threads").get_to(s.request.threads);
  json.at("final_state").get_to(s.final_state);
  json.at("listing_frames").get_to(s.listing_frames);
  json.at("ledger").get_to(s.ledger);
  json.at("quiet").get_to(s.quiet);
  json.at("resumed").get_to(s.resumed);
  return head;
}

// Where the two lines of text end; checks the first.
std::size_t end_of_head(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(first_words)) {
    throw InputError(fmt::format("{}: is no checkpoint of bounce", name));
  }
  const std::size_t line = bytes.find('\n');
  const std::string_view number =
      bytes.substr(first_words.size(), std::min(line, bytes.size()) - first_words.size());
  if (number != fmt::format("{}", format)) {
    throw InputError(fmt::format(
        "{}: is a checkpoint in format {}; this program reads format {} alone: allowed is the "
        "program that wrote it",
        name, number.substr(0, 20), format));
  }
  const std::size_t end = bytes.find('\n', line + 1);
  return end == std::string_view::npos ? bytes.size() : end + 1;
}

// The words between head and end, if all is as it was written.
std::vector<std::uint64_t> checked_words(std::string_view bytes, std::size_t head,
                                         const std::string& name) {
  const auto refuse = [&name](const char* why) {
    return InputError(fmt::format("{}: {}", name, why));
  };
  const std::vector<std::uint64_t> all = words_of(bytes);
  if (bytes.size() % 8 != 0 || head % 8 != 0 || all.size() < head / 8 + 2 ||
      all[all.size() - 2] != all.size() - 2) {
    throw refuse("is not whole: it was cut off, or changed since it was written");
  }
  Checksum sum;
  sum.add(std::span(all).first(all.size() - 1));
  if (sum.value() != all.back()) {
    throw refuse("is damaged: its checksum is not that of what it holds");
  }
  return {all.begin() + static_cast<std::ptrdiff_t>(head / 8), all.end() - 2};
}

void write_all(OutputFile& file, const CheckpointHead& head,
               const std::function<void(WordWriter&)>& body) {
  Checksum sum;
  std::uint64_t count = 0;
  const auto put = [&](std::span<const std::uint64_t> words) {
    sum.add(words);
    count += words.size();
    file.write(bytes_of(words));
  };
  put(words_of(head_text(head)));
  WordWriter writer(put);
  body(writer);
  writer.finish();
  const std::array<std::uint64_t, 1> number{count};
  put(number);
  const std::array<std::uint64_t, 1> checksum{sum.value()};
  file.write(bytes_of(checksum));
}

// The name `before` for the file at `now`, which keeps its own.
void keep_before(const fs::path& now, const fs::path& before) {
  std::error_code ignored;
  if (!fs::exists(now, ignored)) return;
  const fs::path next = make_beside(before, "partial", [&now](const fs::path& name) {
    return ::link(now.c_str(), name.c_str()) == 0;
  });
  fs::rename(next, before, ignored);
  fs::remove(next, ignored);  // where both names were the same file's, rename() leaves both
}

}  // namespace

std::uint64_t hash_of(Scene scene) {
  scene.time.end = scene.time.step;
  Checksum sum;
  sum.add(to_toml(scene));
  return sum.value();
}

void write_checkpoint(const fs::path& folder, const CheckpointHead& head,
                      const std::function<void(WordWriter&)>& body, bool to_disk) {
  const fs::path now = folder / checkpoint_name;
  write_file_whole(now, [&](OutputFile& file) {
    write_all(file, head, body);
    if (to_disk) file.sync();
    file.flush();
    keep_before(now, folder / before_name);
  });
  if (to_disk) sync_folder(folder);
}

void seal_checkpoint(std::string& bytes) {
  std::vector<std::uint64_t> words = words_of(bytes);
  if (words.size() < 2) return;
  words[words.size() - 2] = words.size() - 2;
  Checksum sum;
  sum.add(std::span(words).first(words.size() - 1));
  words.back() = sum.value();
  bytes.assign(bytes_of(words));
}

Checkpoint read_checkpoint(const std::string& bytes, const std::string& name, bool any_commit) {
  const std::size_t end = end_of_head(bytes, name);
  Checkpoint checkpoint;
  checkpoint.words = checked_words(bytes, end, name);
  const std::size_t line = bytes.find('\n') + 1;
  try {
    checkpoint.head = read_head(std::string_view(bytes).substr(line, end - line));
  } catch (const std::exception& error) {
    throw InputError(  // which may quote all that it read
        fmt::format("{}: what it says of its run cannot be read: {}", name,
                    std::string_view(error.what()).substr(0, 200)));
  }
  const Origin origin = find_origin();
  if (checkpoint.head.commit != origin.commit && !any_commit) {
    throw InputError(fmt::format(
        "{}: was written by bounce {} (commit {}); this is {} (commit {}), which may round "
        "otherwise: allowed is the program that wrote it, or --force",
        name, checkpoint.head.version, checkpoint.head.commit, origin.version, origin.commit));
  }
  return checkpoint;
}

Checkpoint load_checkpoint(const fs::path& folder, bool before, bool any_commit) {
  const auto load = [&](const char* name) {
    const std::string path = (folder / name).string();
    return read_checkpoint(read_bytes(path), path, any_commit);
  };
  if (before) return load(before_name);
  try {
    return load(checkpoint_name);
  } catch (const InputError& error) {
    std::string offer;
    try {
      const Checkpoint other = load(before_name);
      offer = fmt::format(
          "\nthe one before it, of step {} (t = {:.9g} s), is whole: \"bounce resume "
          "--before {}\" takes it",
          other.head.step, other.head.time, folder.string());
    } catch (const InputError&) {  // nor is that
    }
    throw InputError(error.what() + offer);
  }
}

void remove_checkpoints(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / checkpoint_name, ignored);
  remove_checkpoint_before(folder);
}

void remove_checkpoint_before(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / before_name, ignored);
}

}  // namespace bounce
