// CSV and tables of columns, read back by the names of their columns.
#pragma once

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace bounce {

/// What a cell should hold: a number (compared as one, to 6 digits, which some columns are cut to)
/// or a text.
struct Cell {
  Cell(double is) : number(is) {}                  // NOLINT(google-explicit-constructor)
  Cell(std::string is) : text(std::move(is)) {}    // NOLINT(google-explicit-constructor)
  Cell(const char* is) : Cell(std::string(is)) {}  // NOLINT(google-explicit-constructor)
  double number = std::nan("");
  std::string text;
};

using Row = std::map<std::string, std::string>;
using Cells = std::map<std::string, Cell>;

/// The cells of a line of CSV; quotes round a cell are taken off.
inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"') {
      cells.back() += line[k++];
    } else if (line[k] == '"') {
      quoted = !quoted;
    } else if (line[k] == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[k];
    }
  }
  return cells;
}

/// Rows by column. A column named twice and a row of another length are failures.
inline std::vector<Row> read_table(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells_of(line);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << line;
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), names.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t c = 0; c < std::min(cells.size(), names.size()); ++c) row[names[c]] = cells[c];
  }
  return rows;
}

/// Every column is expected, and every cell is as expected.
inline void expect_row(const Row& row, const Cells& expected) {
  for (const auto& [name, text] : row) EXPECT_EQ(expected.count(name), 1U) << name << " = " << text;
  for (const auto& [name, cell] : expected) {
    const auto found = row.find(name);
    if (found == row.end()) {
      ADD_FAILURE() << "no column " << name;
    } else if (std::isnan(cell.number)) {
      EXPECT_EQ(found->second, cell.text) << name;
    } else {
      char* end = nullptr;
      const double number = std::strtod(found->second.c_str(), &end);
      EXPECT_TRUE(!found->second.empty() && *end == '\0') << name << " = " << found->second;
      EXPECT_NEAR(number, cell.number, 1e-6 * std::abs(cell.number)) << name;
    }
  }
}

}  // namespace bounce
