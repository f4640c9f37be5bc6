#include "driver/scene/state_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "driver/world/files.hpp"
#include "driver/world/input_error.hpp"
#include "verify/oracle/listing_frame.hpp"

namespace bounce {
namespace {

constexpr std::string_view csv_header = "i,x,y,vx,vy";
constexpr std::string_view held_header = "i,x,y,vx,vy,held_x,held_y,held_vx,held_vy";
constexpr std::array<const char*, 8> column_names{"x",      "y",      "vx",      "vy",
                                                  "held_x", "held_y", "held_vx", "held_vy"};

struct Line {
  const std::string& path;
  std::size_t number;
  std::string_view text;

  [[nodiscard]] InputError refuse(std::string_view key, std::string_view value,
                                  std::string_view allowed) const {
    return InputError(
        fmt::format("{}:{}: {} = \"{:.40}\": allowed is {}", path, number, key, value, allowed));
  }
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The whole of `text` as a number; from_chars takes no leading plus sign.
template <class Number>
bool parse(std::string_view text, Number& out) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size();
}

void append(State& state, const double* values) {
  state.x.push_back(values[0]);
  state.y.push_back(values[1]);
  state.vx.push_back(values[2]);
  state.vy.push_back(values[3]);
}

void read_csv_line(const Line& line, FiledState& filed) {
  std::vector<std::string_view> cells;
  for (std::string_view rest = line.text;;) {
    const auto comma = rest.find(',');
    cells.push_back(trimmed(rest.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  const std::size_t columns = filed.held ? 9 : 5;
  if (cells.size() != columns) {
    throw line.refuse("line", line.text,
                      fmt::format("{} values, {}", columns, filed.held ? held_header : csv_header));
  }
  std::size_t number = 0;
  if (!parse(cells[0], number) || number != filed.state.size() + 1) {
    throw line.refuse("i", cells[0],
                      fmt::format("{}, the particle's number", filed.state.size() + 1));
  }
  std::array<double, 8> values{};
  for (std::size_t c = 0; c + 1 < columns; ++c) {
    if (!parse(cells[c + 1], values[c])) {
      throw line.refuse(column_names[c], cells[c + 1], "a number");
    }
  }
  append(filed.state, values.data());
  if (filed.held) append(*filed.held, values.data() + 4);
}

FiledState read_csv(const std::string& path, std::string_view rest, bool with_held) {
  FiledState filed;
  if (with_held) filed.held.emplace();
  while (rest.ends_with("\n\n") || rest.ends_with("\n\r\n")) {
    rest.remove_suffix(rest.ends_with("\n\n") ? 1 : 2);
  }
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const auto end = rest.find('\n');
    const Line line{path, number, rest.substr(0, end)};
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (number > 1) read_csv_line(line, filed);
  }
  if (filed.state.size() == 0) throw InputError(path + ": holds no particles");
  return filed;
}

// A number that is cut off in its middle is a number, too: only the line's end tells.
void check_end(const std::string& path, std::string_view text) {
  if (text.empty()) throw InputError(path + ": the file is empty; allowed is a state");
  if (text.ends_with('\n')) return;
  const auto line = std::count(text.begin(), text.end(), '\n') + 1;
  throw InputError(
      fmt::format("{}:{}: the last line has no end: the file may have been cut there; allowed is a "
                  "line feed after every line",
                  path, line));
}

}  // namespace

void write_state_csv(OutputFile& file, const State& state, const std::optional<State>& held) {
  fmt::memory_buffer out;
  const auto end = std::back_inserter(out);
  const auto put = [&end](const State& s, std::size_t i) {
    fmt::format_to(end, ",{:.17g},{:.17g},{:.17g},{:.17g}", s.x[i], s.y[i], s.vx[i], s.vy[i]);
  };
  fmt::format_to(end, "{}\n", held ? held_header : csv_header);
  for (std::size_t i = 0; i < state.size(); ++i) {
    fmt::format_to(end, "{}", i + 1);
    put(state, i);
    if (held) put(*held, i);
    out.push_back('\n');
    file.write_large(out);
  }
  file.write({out.data(), out.size()});
}

FiledState read_state(const std::string& path) { return parse_state(read_text_file(path), path); }

FiledState parse_state(std::string_view text, const std::string& name) {
  check_end(name, text);
  const std::string_view first = trimmed(text.substr(0, text.find('\n')));
  if (first == csv_header || first == held_header) {
    return read_csv(name, text, first == held_header);
  }
  try {
    std::istringstream in{std::string(text)};
    return {read_listing_frame(in), std::nullopt};
  } catch (const std::runtime_error& error) {
    throw InputError(
        fmt::format("{}: {} (allowed is the listing's format, 4F12.4, or a file that "
                    "begins with {})",
                    name, error.what(), csv_header));
  }
}

}  // namespace bounce
