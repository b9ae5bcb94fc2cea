// Numbers for Markdown.
#pragma once

#include <string>

namespace depthgrid::lab {

/// Three significant digits without exponent: "0.0123", "4.56", "12300"; "-" for NaN.
[[nodiscard]] std::string digits3(double value);
/// As a whole number with blanks between thousands; "-" for NaN.
[[nodiscard]] std::string whole(double value);

/// Seconds, metres and counts as the page shows them; "-" for NaN.
[[nodiscard]] std::string milliseconds(double value_s);
[[nodiscard]] std::string microseconds(double value_s);
/// To a tenth below 10 mm, else whole.
[[nodiscard]] std::string millimetres(double value_m);

}  // namespace depthgrid::lab
