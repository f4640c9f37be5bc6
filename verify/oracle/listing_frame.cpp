#include "verify/oracle/listing_frame.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <istream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace bounce {
namespace {

constexpr std::size_t width = 12;
constexpr std::string_view blanks = " \t\r";

void write_number(std::ostream& out, double x) {
  std::array<char, 400> text{};  // the greatest double has 309 digits before the point
  std::snprintf(text.data(), text.size(), "%.4f", x);
  std::string_view field(text.data());
  if (std::isnan(x)) field = "NaN";
  if (std::isinf(x)) field = x > 0.0 ? "Infinity" : "-Infinity";
  if (field.size() > width) field = "************";
  out << std::string(width - field.size(), ' ') << field;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> found;
  for (auto at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
    const auto end = line.find_first_of(blanks, at);
    found.push_back(line.substr(at, end - at));
    at = end == std::string_view::npos ? end : line.find_first_not_of(blanks, end);
  }
  return found;
}

// Four fields of 12 columns, which may touch each other; none if the line is not of that width.
std::vector<std::string_view> columns(std::string_view line) {
  if (line.size() <= 3 * width || line.size() > 4 * width) return {};
  std::vector<std::string_view> found;
  for (std::size_t k = 0; k < 4; ++k) found.push_back(trimmed(line.substr(k * width, width)));
  return found;
}

[[noreturn]] void fail(std::size_t line, const std::string& what) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + what);
}

double number(std::string_view word, std::size_t line) {
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0.0;
  const char* const last = digits.data() + digits.size();
  const auto result = std::from_chars(digits.data(), last, value);
  if (result.ec != std::errc() || result.ptr != last || !std::isfinite(value)) {
    std::string quoted(1, '"');  // += throughout: GCC 12 warns wrongly of "..." + std::string
    quoted += word.substr(0, 40);
    fail(line, quoted += "\" is not a finite number");
  }
  return value;
}

}  // namespace

void write_listing_frame(std::ostream& out, const State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (const double x : {state.x[i], state.y[i], state.vx[i], state.vy[i]}) write_number(out, x);
    out << '\n';
  }
}

State read_listing_frame(std::istream& in) {
  State state;
  std::size_t line_number = 0;
  std::size_t blank_line = 0;  // the first one, if any
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    while (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string_view> fields = words(line);
    if (fields.empty()) {
      if (blank_line == 0) blank_line = line_number;
      continue;
    }
    if (blank_line != 0) fail(blank_line, "a blank line between particles");
    if (fields.size() < 4) {
      if (auto fixed = columns(line); !fixed.empty()) fields = fixed;
    }
    if (fields.size() != 4) {
      fail(line_number,
           std::to_string(fields.size()) +
               " numbers; expected are 4, x y vx vy, as 4F12.4 or separated by blanks");
    }
    state.x.push_back(number(fields[0], line_number));
    state.y.push_back(number(fields[1], line_number));
    state.vx.push_back(number(fields[2], line_number));
    state.vy.push_back(number(fields[3], line_number));
  }
  if (state.size() == 0) throw std::runtime_error("no particles: the file is empty");
  return state;
}

}  // namespace bounce
