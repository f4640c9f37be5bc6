# Writes OUT, the definition of built_in_scenes(), from all .toml files of DIR.
file(GLOB files "${DIR}/*.toml")
list(SORT files)
set(entries "")
foreach(path IN LISTS files)
  get_filename_component(name "${path}" NAME_WE)
  file(READ "${path}" text)
  string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
file(WRITE "${OUT}" "// Generated from driver/scenes/ by embed_scenes.cmake.
#include \"driver/built_in_scenes.hpp\"

namespace bounce {

std::span<const BuiltInScene> built_in_scenes() {
  static constexpr BuiltInScene scenes[] = {
${entries}  };
  return scenes;
}

}  // namespace bounce
")
