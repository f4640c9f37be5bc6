# Writes OUT, the definitions of built_in_scenes() and extreme_scenes(), from all .toml files of DIR and
# DIR/extremes. Text passes through no CMake list, which would eat semicolons and brackets.
function(embed directory result)
  file(GLOB files "${directory}/*.toml")
  list(SORT files)
  set(entries "")
  foreach(path IN LISTS files)
    get_filename_component(name "${path}" NAME_WLE)
    file(READ "${path}" text)
    string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
  endforeach()
  set(${result} "${entries}" PARENT_SCOPE)
endfunction()
embed("${DIR}" scenes)
embed("${DIR}/extremes" extremes)
file(WRITE "${OUT}" "// Generated from driver/scenes/ by embed_scenes.cmake.
#include \"driver/scene/built_in_scenes.hpp\"

namespace bounce {

std::span<const BuiltInScene> built_in_scenes() {
  static constexpr BuiltInScene scenes[] = {
${scenes}  };
  return scenes;
}

std::span<const BuiltInScene> extreme_scenes() {
  static constexpr BuiltInScene scenes[] = {
${extremes}  };
  return scenes;
}

}  // namespace bounce
")
