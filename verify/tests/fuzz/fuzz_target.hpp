// What the fuzz targets share: what of a reader's behaviour is a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "driver/world/input_error.hpp"

namespace bounce {

/// Ends the program, so that the fuzzer keeps the input, unless `holds`.
inline void must_hold(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

/// Whether a terminal can show it as it is: UTF-8 without control characters but line feeds.
inline bool is_plain(std::string_view text) {
  for (std::size_t at = 0, length = 0; at < text.size(); at += length) {
    length = utf8_length(text, at);
    const bool is_control = length == 1 && static_cast<unsigned char>(text[at]) < 0x20;
    if (length == 0 || (is_control && text[at] != '\n')) return false;
  }
  return true;
}

/// Calls read(text) on an input. It may refuse it with an InputError that can be read, on one line
/// or a few; anything else it throws is a finding.
template <class Read>
int fuzz(const std::uint8_t* data, std::size_t size, const Read& read) {
  constexpr std::size_t longest = 3000;  // bytes; a message may list all keys
  try {
    read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    must_hold(!message.empty() && message.size() <= longest, "a message has 1 to 3000 bytes");
    must_hold(is_plain(message), "a message can be read");
  }
  return 0;
}

}  // namespace bounce

/// libFuzzer's name for a target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
