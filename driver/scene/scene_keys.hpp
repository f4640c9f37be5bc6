// The table of scene keys: reading a file, writing one and --set all go through it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "kernels/model/scene.hpp"

namespace bounce {

/// One key of a scene file; Owner is Scene, or Wall for the keys of a [[wall]].
template <class Owner>
struct Key {
  std::string table;  ///< the [table] it stands in; "" at the top of the file
  std::string name;
  std::string note;     ///< unit or meaning, written as a comment
  std::string allowed;  ///< which values it takes, for messages
  /// Takes the value, or returns false and changes nothing if it has the wrong type.
  std::function<bool(const toml::node&, Owner&)> read;
  /// The value as TOML that reads back the same; "" if the owner has none.
  std::function<std::string(const Owner&)> write;

  /// As users name it: "ball.radii".
  [[nodiscard]] std::string path() const { return table.empty() ? name : table + "." + name; }
};

/// All keys but the walls', in the order of a scene file.
const std::vector<Key<Scene>>& scene_keys();

/// The keys of one [[wall]].
const std::vector<Key<Wall>>& wall_keys();

/// A contact as scene files name it: "listing" ...
std::string_view word_of(Contact contact);
/// That of that name; nothing if there is none.
std::optional<Contact> contact_of(std::string_view word);
/// All names, for messages.
std::string contact_words();

}  // namespace bounce
