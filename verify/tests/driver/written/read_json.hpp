// Values of a JSON text, by their places.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace bounce {

using Json = nlohmann::json;

struct Value {
  std::string at;  // JSON pointer
  Json is;
};

/// Each is there, and is as it says.
inline void expect_values(const Json& json, const std::vector<Value>& values) {
  for (const Value& each : values) {
    const Json::json_pointer at(each.at);
    if (!json.contains(at)) {
      ADD_FAILURE() << "no " << each.at;
    } else {
      EXPECT_EQ(json.at(at), each.is) << each.at;
    }
  }
}

}  // namespace bounce
