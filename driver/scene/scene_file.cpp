#include "driver/scene/scene_file.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/scene/built_in_scenes.hpp"
#include "driver/scene/scene_keys.hpp"
#include "driver/world/files.hpp"
#include "driver/world/near_miss.hpp"

namespace bounce {

namespace {

std::string shortened(std::string text) {
  constexpr std::size_t longest = 80;
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() > longest) text = text.substr(0, longest - 4) + " ...";
  return text;
}

std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  std::ostringstream out;
  out << toml::toml_formatter(node, toml::format_flags::none);
  return shortened(out.str());
}

InputError bad_value(const std::string& origin, const std::string& key, const std::string& value,
                     const std::string& allowed) {
  return InputError(fmt::format("{}: {} = {}: allowed is {}", origin, key, value, allowed));
}

InputError unknown_key(const std::string& origin, const std::string& key,
                       const std::string& value) {
  const std::vector<std::string> names = scene_key_names();
  // Of a known table, its own keys are list enough.
  const std::string table = key.substr(0, key.find_first_of(".["));
  std::vector<std::string> allowed;
  for (const std::string& name : names) {
    if (name.starts_with(table + ".")) allowed.push_back(name);
  }
  return InputError(fmt::format("{}: {} = {}: no such key{} (allowed are: {})", origin, key, value,
                                did_you_mean(key, names),
                                fmt::join(allowed.empty() ? names : allowed, ", ")));
}

template <class Owner>
const Key<Owner>* find_key(const std::vector<Key<Owner>>& keys, const std::string& path) {
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&](const Key<Owner>& key) { return key.path() == path; });
  return found == keys.end() ? nullptr : &*found;
}

bool is_table_name(const std::string& name) {
  const auto& keys = scene_keys();
  return !name.empty() &&
         std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return key.table == name; });
}

std::string wall_path(std::size_t wall) { return fmt::format("wall[{}]", wall); }

std::string line_of(std::string_view text, std::size_t number) {
  for (std::size_t line = 1; line < number; ++line) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return "";
    text.remove_prefix(end + 1);
  }
  return shortened(std::string(text.substr(0, text.find_first_of("\r\n"))));
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// The one value that `text` is in TOML; nothing if it is not one.
std::optional<toml::table> as_toml(const std::string& text) {
  try {
    toml::table table = toml::parse("value = " + text);
    if (table.size() == 1) return table;
  } catch (const toml::parse_error&) {
  }
  return std::nullopt;
}

template <class Owner>
void write_key(std::string& out, const Key<Owner>& key, const Owner& owner) {
  const std::string value = key.write(owner);
  if (value.empty()) return;
  const std::string line = key.name + " = " + value;
  out += key.note.empty() ? line + "\n" : fmt::format("{:<30} # {}\n", line, key.note);
}

}  // namespace

struct SceneFile::Reader {
  SceneFile& file;
  std::string source;  // the file or option that is being read
  bool has_lines;

  [[nodiscard]] std::string at(const toml::source_region& region) const {
    return has_lines ? fmt::format("{}:{}", source, region.begin.line) : source;
  }
  void table(const toml::table& table, const std::string& prefix);
  void entry(const std::string& path, const toml::node& node);
  void walls(const toml::node& node);
  void wall_entry(std::size_t wall, const std::string& name, const toml::node& node);
  void option(const std::string& key, const toml::node& node);
  void wall_option(const std::string& key, const toml::node& node);
};

SceneFile SceneFile::parse(std::string_view text, const std::string& name) {
  SceneFile file;
  file.name_ = name;
  try {
    const toml::table table = toml::parse(text);
    Reader{file, name, true}.table(table, "");
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    throw InputError(fmt::format("{}:{}: `{}` is not TOML: {}", name, line, line_of(text, line),
                                 error.description()));
  }
  return file;
}

SceneFile SceneFile::read(const std::string& path) {
  const std::string text = read_text_file(path);
  SceneFile file = parse(text, path);
  if (file.origins_.empty() && file.scene_.walls.empty()) {
    throw InputError(fmt::format(
        "{}: {}; allowed is a scene that says at least one key (bounce show example-1 prints one)",
        path, text.empty() ? "the file is empty" : "the file holds no key"));
  }
  return file;
}

SceneFile SceneFile::find(const std::string& name) {
  std::vector<std::string> names;
  for (const BuiltInScene& scene : built_in_scenes()) {
    if (scene.name == name) return parse(scene.text, name + " (built in)");
    names.emplace_back(scene.name);
  }
  for (const BuiltInScene& scene : extreme_scenes()) {
    if ("extremes/" + std::string(scene.name) == name) return parse(scene.text, name);
  }
  std::error_code ignored;
  if (name.find('/') != std::string::npos || name.ends_with(".toml") ||
      std::filesystem::exists(name, ignored)) {
    return read(name);
  }
  throw InputError(fmt::format("{}: neither a built-in scene nor a file{} (built in are: {})", name,
                               did_you_mean(name, names), fmt::join(names, ", ")));
}

void SceneFile::Reader::table(const toml::table& entries, const std::string& prefix) {
  for (const auto& [key, node] : entries) {
    const std::string path = prefix + std::string(key.str());
    if (path == "extreme" && node.is_table()) continue;  // of bounce extremes: extreme_row.hpp
    if (prefix.empty() && is_table_name(path)) {
      if (!node.is_table()) {
        throw bad_value(at(key.source()), path, shown(node), "a table, [" + path + "]");
      }
      table(*node.as_table(), path + ".");
    } else if (path == "wall") {
      walls(node);
    } else {
      entry(path, node);
    }
  }
}

void SceneFile::Reader::entry(const std::string& path, const toml::node& node) {
  const std::string origin = at(node.source());
  const Key<Scene>* key = find_key(scene_keys(), path);
  if (key == nullptr) throw unknown_key(origin, path, shown(node));
  if (!key->read(node, file.scene_)) throw bad_value(origin, path, shown(node), key->allowed);
  file.origins_[path] = origin;
}

void SceneFile::Reader::walls(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    throw bad_value(at(node.source()), "wall", shown(node), "a list of tables, [[wall]]");
  }
  file.scene_.walls.assign(array->size(), Wall{});
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::node& element = *array->get(i);
    if (!element.is_table()) {
      throw bad_value(at(element.source()), wall_path(i), shown(element), "a table, [[wall]]");
    }
    file.origins_[wall_path(i)] = at(element.source());
    for (const auto& [key, value] : *element.as_table()) {
      wall_entry(i, std::string(key.str()), value);
    }
  }
}

void SceneFile::Reader::wall_entry(std::size_t wall, const std::string& name,
                                   const toml::node& node) {
  const std::string origin = at(node.source());
  const std::string path = wall_path(wall) + "." + name;
  const Key<Wall>* key = find_key(wall_keys(), "wall." + name);
  if (key == nullptr) throw unknown_key(origin, path, shown(node));
  if (!key->read(node, file.scene_.walls[wall])) {
    throw bad_value(origin, path, shown(node), key->allowed);
  }
  file.origins_[path] = origin;
}

void SceneFile::Reader::option(const std::string& key, const toml::node& node) {
  if (key == "wall") return walls(node);
  if (key.starts_with("wall.") || key.starts_with("wall[")) return wall_option(key, node);
  entry(key, node);
  if (key == "output.frames_every") file.scene_.output.frames_at.clear();
  if (key == "output.frames_at") file.scene_.output.frames_every.reset();
}

// wall.NAME is every wall's, wall[I].NAME one wall's.
void SceneFile::Reader::wall_option(const std::string& key, const toml::node& node) {
  const std::size_t walls_in_scene = file.scene_.walls.size();
  std::size_t first = 0;
  std::size_t last = walls_in_scene;
  std::string name = key.substr(5);
  if (key[4] == '[') {
    const char* const key_end = key.data() + key.size();
    const auto [end, error] = std::from_chars(key.data() + 5, key_end, first);
    const std::string rest(end, key_end);
    if (error != std::errc{} || !rest.starts_with("].")) {
      throw InputError(fmt::format("{}: {}: allowed is wall[0].alpha and the like", source, key));
    }
    name = rest.substr(2);
    last = first + 1;
  }
  if (find_key(wall_keys(), "wall." + name) == nullptr) {
    throw unknown_key(source, key, shown(node));
  }
  if (first >= walls_in_scene) {
    throw InputError(fmt::format("{}: {} = {}: the scene has {} wall(s), numbered from 0", source,
                                 key, shown(node), walls_in_scene));
  }
  for (std::size_t i = first; i < last; ++i) wall_entry(i, name, node);
}

void SceneFile::set(const std::string& assignment) {
  Reader reader{*this, "--set", false};
  // What is written into the run's scene.toml has to read back.
  if (const std::string fault = fault_of_line(assignment); !fault.empty()) {
    throw InputError(fmt::format("--set {}: {}", shortened(assignment), fault));
  }
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw InputError(fmt::format("--set {}: allowed is key=value, as in law.elasticity=1000",
                                 shortened(assignment)));
  }
  const std::string key = trimmed(assignment.substr(0, equals));
  const std::string text = trimmed(assignment.substr(equals + 1));
  if (const auto value = as_toml(text)) return reader.option(key, *value->get("value"));
  reader.option(key, toml::value<std::string>(text));
}

void SceneFile::end_after(std::int64_t steps, const std::string& option) {
  end_at(static_cast<double>(steps) * scene_.time.step, option);
}

void SceneFile::end_at(double end, const std::string& option) {
  scene_.time.end = end;
  origins_["time.end"] = option;
  if (!(scene_.time.step > 0.0 && end > 0.0)) return;  // scene() says what is wrong
  const double last = end + 0.5 * scene_.time.step;    // frames stand at the nearest step
  std::erase_if(scene_.output.frames_at, [last](double t) { return t > last; });
}

Scene SceneFile::scene() const {
  Scene scene = scene_;
  // The author's input file had four decimals; who builds another ball asks for them or has none.
  const bool is_papers = scene.ball.kind == BallKind::rings && scene.ball.per_ring == 120 &&
                         scene.ball.radii == BallSpec().radii;
  if (!is_papers && origins_.count("ball.rounding") == 0) scene.ball.rounding = Rounding::none;
  try {
    validate(scene);
  } catch (const SceneError& error) {
    throw explain(error);
  }
  return scene;
}

InputError SceneFile::explain(const SceneError& error) const {
  const auto origin = [this](const std::string& key) {
    const auto found = origins_.find(key);
    return found == origins_.end() ? std::string() : found->second;
  };
  std::string where = origin(error.key);
  if (where.empty()) where = origin(error.key.substr(0, error.key.rfind('[')));  // a list's element
  if (!where.empty()) return bad_value(where, error.key, error.value, error.allowed);
  where = origin(error.key.substr(0, error.key.rfind('.')));  // a wall's default
  return bad_value(where.empty() ? name_ : where, error.key, error.value + " (the default)",
                   error.allowed);
}

std::string to_toml(const Scene& scene) {
  std::string out;
  std::string table;
  const auto write_walls = [&] {
    for (const Wall& wall : scene.walls) {
      out += "\n[[wall]]\n";
      for (const auto& key : wall_keys()) write_key(out, key, wall);
    }
  };
  for (const auto& key : scene_keys()) {
    if (key.table != table) {
      if (key.table == "time") write_walls();
      out += "\n[" + key.table + "]\n";
      table = key.table;
    }
    write_key(out, key, scene);
  }
  return out;
}

std::vector<std::string> scene_key_names() {
  std::vector<std::string> names;
  for (const auto& key : scene_keys()) names.push_back(key.path());
  for (const auto& key : wall_keys()) names.push_back(key.path());
  return names;
}

}  // namespace bounce
