// A table for Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace depthgrid::report {

/// Lines of "| a | b |" under a head. One thread.
class MarkdownTable {
 public:
  explicit MarkdownTable(const std::vector<std::string>& head);

  /// Throws Error unless there are as many cells as in the head.
  void row(const std::vector<std::string>& cells);

  /// Without a line break at the end.
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::size_t columns_;
  std::string text_;
};

}  // namespace depthgrid::report
