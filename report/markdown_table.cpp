#include "report/markdown_table.hpp"

#include "depthgrid/core/error.hpp"

namespace depthgrid::report {

namespace {

std::string table_line(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) {
    text += " " + cell + " |";
  }
  return text;
}

}  // namespace

MarkdownTable::MarkdownTable(const std::vector<std::string>& head)
    : columns_(head.size()), text_(table_line(head) + "\n|") {
  for (std::size_t i = 0; i < columns_; ++i) {
    text_ += "---|";
  }
}

void MarkdownTable::row(const std::vector<std::string>& cells) {
  if (cells.size() != columns_) {
    fail("table row with ", cells.size(), " cells under a head of ", columns_);
  }
  text_ += "\n" + table_line(cells);
}

}  // namespace depthgrid::report
