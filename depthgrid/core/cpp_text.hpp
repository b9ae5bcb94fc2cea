// C++ that makes the same value again, bit for bit, for reproductions. Internal.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid {

/// The shortest number that is read as the same one. The sign and the other bits of NaN are lost.
[[nodiscard]] std::string cpp_text(double value);
[[nodiscard]] std::string cpp_text(int value);
[[nodiscard]] std::string cpp_text(bool value);
[[nodiscard]] std::string cpp_text(std::string_view text);
std::string cpp_text(const char* text) = delete;  // would be taken for a bool
[[nodiscard]] std::string cpp_text(const Eigen::Vector3d& value);
[[nodiscard]] std::string cpp_text(const Pose& pose);
[[nodiscard]] std::string cpp_text(const CameraMargins& margins);

template <class Value>
[[nodiscard]] std::string cpp_text(const std::optional<Value>& value) {
  return value ? cpp_text(*value) : "std::nullopt";
}

/// "{a, b}"
template <class... Values>
[[nodiscard]] std::string cpp_list(const Values&... values) {
  std::string text;
  ((text += (text.empty() ? "{" : ", ") + cpp_text(values)), ...);
  return text + "}";
}

/// "{a, b}", or with `between` = ",\n  " an element a line.
template <class Range>
[[nodiscard]] std::string cpp_range(const Range& values, const char* between = ", ") {
  std::string text = "{";
  for (const auto& value : values) {
    text += (text.size() == 1 ? "" : between) + cpp_text(value);
  }
  return text + "}";
}

}  // namespace depthgrid
