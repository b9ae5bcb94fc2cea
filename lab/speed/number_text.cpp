#include "lab/speed/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace depthgrid::lab {

std::string digits3(double value) {
  if (!std::isfinite(value)) {
    return "-";
  }
  if (value == 0) {
    return "0";
  }
  const int before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  std::ostringstream text;
  text << std::fixed << std::setprecision(std::clamp(3 - before_point, 0, 6)) << value;
  return before_point > 4 ? whole(value) : text.str();
}

std::string whole(double value) {
  if (!std::isfinite(value)) {
    return "-";
  }
  std::string digits = std::to_string(std::llround(value));
  for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > (digits.front() == '-' ? 1 : 0); at -= 3) {
    if (digits.size() > 4) {
      digits.insert(static_cast<std::size_t>(at), " ");
    }
  }
  return digits;
}

std::string milliseconds(double value_s) { return digits3(1e3 * value_s); }
std::string microseconds(double value_s) { return digits3(1e6 * value_s); }
std::string millimetres(double value_m) {
  const double value = std::round(1e4 * value_m) / 10;
  return std::isnan(value) ? "-" : value >= 10 ? whole(value) : digits3(value).substr(0, 3);
}

}  // namespace depthgrid::lab
