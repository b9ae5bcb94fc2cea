#include "lab/recordings/figures.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace depthgrid::lab {

double quantile(std::vector<double> values, double q) {
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto rank = static_cast<std::ptrdiff_t>(std::lround(q * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

std::string number(double value, int decimals) {
  if (std::isnan(value)) {
    return "-";
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string share(double part, double whole) { return whole == 0 ? "-" : number(100 * part / whole, 1) + " %"; }

std::string percent(double part, double whole) { return whole == 0 ? "-" : number(100 * part / whole, 2) + " %"; }

std::string millimetres(double value_m) {
  const std::string text = number(1e3 * value_m, 0);
  return text == "-" || value_m <= 0 ? (text == "-0" ? "0" : text) : "+" + text;
}

}  // namespace depthgrid::lab
