// Numbers of the page: seconds, metres and counts as it shows them; "-" for NaN.
#pragma once

#include <cmath>
#include <string>

#include "report/number_text.hpp"

namespace depthgrid::lab {

[[nodiscard]] inline std::string whole(double value) {
  return std::isfinite(value) ? report::grouped(std::llround(value)) : "-";
}
[[nodiscard]] inline std::string milliseconds(double value_s) { return report::three_digits(1e3 * value_s); }
[[nodiscard]] inline std::string microseconds(double value_s) { return report::three_digits(1e6 * value_s); }
/// To a tenth below 10 mm, else whole.
[[nodiscard]] inline std::string millimetres(double value_m) {
  const double value = std::round(1e4 * value_m) / 10;
  return value >= 10 ? whole(value) : report::three_digits(value).substr(0, 3);
}

}  // namespace depthgrid::lab
