// What depthgrid distances wrote, by row and column.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program/command.hpp"

namespace depthgrid::test {

/// One answer by its column's name.
class Row {
 public:
  Row(const std::string& header, const std::string& line) : names_(cells(header)), values_(cells(line)) {}

  [[nodiscard]] std::string text(const std::string& name) const {
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (names_[k] == name) {
        return values_.at(k);
      }
    }
    ADD_FAILURE() << "no column " << name;
    return {};
  }
  [[nodiscard]] double number(const std::string& name) const { return std::stod(text(name)); }

 private:
  static std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> result(1);
    for (const char c : line) {
      c == ',' ? (void)result.emplace_back() : result.back().push_back(c);
    }
    return result;
  }

  std::vector<std::string> names_, values_;
};

inline std::vector<Row> rows_of(const CommandResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> lines(1);
  for (const char c : result.out) {
    c == '\n' ? (void)lines.emplace_back() : lines.back().push_back(c);
  }
  std::vector<Row> rows;
  for (std::size_t k = 1; k + 1 < lines.size(); ++k) {
    rows.emplace_back(lines[0], lines[k]);
  }
  return rows;
}

}  // namespace depthgrid::test
