// Small numbers for tables.
#pragma once

#include <string>
#include <vector>

namespace depthgrid::lab {

/// The q-quantile (nearest rank), 0 <= q <= 1; NaN when empty.
[[nodiscard]] double quantile(std::vector<double> values, double q);

/// Fixed decimals; "-" for NaN.
[[nodiscard]] std::string number(double value, int decimals);
/// Part of a whole as "12.3 %"; "-" when the whole is 0.
[[nodiscard]] std::string share(double part, double whole);
/// The same with two decimals, for rare things.
[[nodiscard]] std::string percent(double part, double whole);
/// Metres as whole millimetres with their sign.
[[nodiscard]] std::string millimetres(double value_m);

}  // namespace depthgrid::lab
