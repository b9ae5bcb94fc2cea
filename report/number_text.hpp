// Numbers as text, independent of the locale: exact ones for programs, short ones for people.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace depthgrid::report {

/// The shortest text that reads back as the same double. NaN gives an empty text.
std::string exact_text(double value);

/// Six decimals; NaN gives an empty text. Metres to a micrometre.
std::string micro_text(double value);

/// Six decimals, rounded towards minus infinity, so that a lower bound stays one. NaN gives an empty text.
std::string micro_text_down(double value);

/// The same towards plus infinity, for an upper bound.
std::string micro_text_up(double value);

/// With so many digits after the point; "-" when not finite.
[[nodiscard]] std::string fixed(double value, int digits = 0);
/// A share as "12.3 %".
[[nodiscard]] std::string percent(double share, int digits = 1);
/// Part of a whole, the same way; "-" when the whole is 0.
[[nodiscard]] std::string percent_of(double part, double whole, int digits = 1);
/// Three significant digits without exponent: "0.0123", "4.56", "12 300"; "-" when not finite.
[[nodiscard]] std::string three_digits(double value);
/// Metres as whole millimetres with their sign: "+12", "-3", "0".
[[nodiscard]] std::string signed_millimetres(double value_m);
/// 1234567 as "1 234 567"; numbers of at most `together` digits stay together.
[[nodiscard]] std::string grouped(std::int64_t value, std::size_t together = 4);

}  // namespace depthgrid::report
