#include "report/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace depthgrid::report {

std::string exact_text(double value) {
  if (std::isnan(value)) {
    return {};
  }
  std::array<char, 32> buffer{};
  auto* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string micro_text(double value) {
  if (std::isnan(value)) {
    return {};
  }
  std::array<char, 400> buffer{};
  auto* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, 6).ptr;
  const std::string text(buffer.data(), end);
  return text == "-0.000000" ? "0.000000" : text;
}

std::string micro_text_down(double value) { return micro_text(std::floor(value * 1e6) / 1e6); }

}  // namespace depthgrid::report
