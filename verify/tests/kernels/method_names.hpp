// The methods of the registry as parameters of tests: a test instantiated over them is generated
// for a new method by its line in the table.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "kernels/model/method.hpp"

namespace bounce {

inline std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Method& method : methods()) names.emplace_back(method.name);
  return names;
}

/// With letters, digits and underscores only, as googletest demands.
inline std::string test_name(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace bounce
