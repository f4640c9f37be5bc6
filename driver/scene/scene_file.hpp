// Scenes as TOML: reading with messages that name file, line, key, value and what is allowed,
// changing with --set, and writing.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "driver/world/input_error.hpp"
#include "kernels/model/scene.hpp"

namespace bounce {

/// A scene under construction that remembers where each of its values came from. Keys that are not
/// given have the defaults of Scene. All functions throw InputError.
class SceneFile {
 public:
  /// Reads TOML; `name` is what messages call it.
  static SceneFile parse(std::string_view text, const std::string& name);
  static SceneFile read(const std::string& path);
  /// `name` is a built-in scene ("example-2", "extremes/gravity-none") or else a file's path.
  static SceneFile find(const std::string& name);

  /// Applies --set key=value. The value is TOML, or else text. `wall.alpha` is every wall's,
  /// `wall[1].alpha` the second one's, `wall` all the walls. The two frame keys replace each other.
  void set(const std::string& assignment);
  /// Ends the run at `end` (s) whatever the scene says, and drops the frames after it; messages
  /// call the origin `option`.
  void end_at(double end, const std::string& option);
  /// Ends it after so many steps, in the same way.
  void end_after(std::int64_t steps, const std::string& option);
  /// Says where the value of a key that is not in the file came from, for messages.
  void note_origin(const std::string& key, const std::string& origin) { origins_[key] = origin; }

  /// The scene, validated.
  [[nodiscard]] Scene scene() const;
  /// The message for an error found later (by make_problem, say), with file and line added.
  [[nodiscard]] InputError explain(const SceneError& error) const;

 private:
  struct Reader;  // takes values from one file or option; keeps toml++ out of this header

  Scene scene_;
  std::string name_;
  std::map<std::string, std::string> origins_;  // key -> "file:line" or "--set"
};

/// All of a scene as TOML. Read back, it gives the identical scene.
std::string to_toml(const Scene& scene);

/// All keys, as users name them.
std::vector<std::string> scene_key_names();

}  // namespace bounce
