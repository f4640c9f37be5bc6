#include "driver/world/input_error.hpp"

#include <cctype>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

namespace bounce {
namespace {

constexpr std::size_t most_digits = 40;   // in a row; no number that means something has more
constexpr std::size_t shown_digits = 20;  // of more

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// U+0080 to U+009F steer terminals as the control characters of ASCII do.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return first < 0x20 || first == 0x7f;
  return first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;
}

std::string escaped(std::string_view bytes) {
  if (bytes == "\n") return "\\n";
  if (bytes == "\r") return "\\r";
  if (bytes == "\t") return "\\t";
  std::string text;
  for (const char byte : bytes) text += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
  return text;
}

std::size_t digits_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end - at;
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() - at < length) return 0;
  std::uint32_t code = first & (0x7fU >> length);
  for (std::size_t i = at + 1; i < at + length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6U | (byte(i) & 0x3fU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return overlong || surrogate || code > 0x10ffff ? 0 : length;
}

std::string plain_nan(std::string text) {
  constexpr std::string_view word = "-nan";
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const bool begins = at == 0 || !(is_part(text[at - 1]) || text[at - 1] == '-');
    const std::size_t end = at + word.size();
    if (begins && (end == text.size() || !is_part(text[end]))) text.erase(at, 1);
  }
  return text;
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t digits = digits_at(text, at); digits > most_digits) {
      out += fmt::format("{}...({} digits)", text.substr(at, shown_digits), digits);
      at += digits;
      continue;
    }
    if (const std::size_t digits = digits_at(text, at); digits > 0) {
      out += text.substr(at, digits);
      at += digits;
      continue;
    }
    const std::size_t length = utf8_length(text, at);
    const std::string_view character = text.substr(at, length == 0 ? 1 : length);
    out += length == 0 || is_control(character) ? escaped(character) : std::string(character);
    at += character.size();
  }
  return plain_nan(std::move(out));
}

}  // namespace bounce
