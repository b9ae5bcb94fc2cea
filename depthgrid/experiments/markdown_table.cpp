#include "depthgrid/experiments/markdown_table.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "depthgrid/core/error.hpp"

namespace depthgrid::experiments {

namespace {

std::string line(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) {
    text += " " + cell + " |";
  }
  return text + "\n";
}

}  // namespace

std::string markdown_table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string text = line(head) + line(std::vector<std::string>(head.size(), "---"));
  for (const auto& row : rows) {
    if (row.size() != head.size()) {
      fail("table row with ", row.size(), " cells under a head of ", head.size());
    }
    text += line(row);
  }
  text.pop_back();
  return text;
}

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) {
    return "-";
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string percent(double share, int digits) { return fixed(100 * share, digits) + " %"; }

}  // namespace depthgrid::experiments
