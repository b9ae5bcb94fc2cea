#include "report/number_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

#include "depthgrid/core/number_parsing.hpp"

namespace depthgrid::report {

std::string exact_text(double value) {
  if (std::isnan(value)) {
    return {};
  }
  return number_text(value);
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

std::string micro_text_up(double value) { return micro_text(std::ceil(value * 1e6) / 1e6); }

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) {
    return "-";
  }
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string percent(double share, int digits) { return fixed(100 * share, digits) + " %"; }

std::string percent_of(double part, double whole, int digits) {
  return whole == 0 ? "-" : fixed(100 * part / whole, digits) + " %";
}

std::string three_digits(double value) {
  if (!std::isfinite(value) || value == 0) {
    return fixed(std::abs(value));
  }
  const int before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return before_point > 4 ? grouped(std::llround(value)) : fixed(value, std::clamp(3 - before_point, 0, 6));
}

std::string signed_millimetres(double value_m) {
  const std::string text = fixed(1e3 * value_m);
  return text == "-" || value_m <= 0 ? (text == "-0" ? "0" : text) : "+" + text;
}

std::string grouped(std::int64_t value, std::size_t together) {
  std::string digits = std::to_string(value);
  const std::size_t sign = value < 0 ? 1 : 0;
  if (digits.size() - sign > together) {
    for (std::size_t at = digits.size(); at > sign + 3;) {
      at -= 3;
      digits.insert(at, " ");
    }
  }
  return digits;
}

}  // namespace depthgrid::report
