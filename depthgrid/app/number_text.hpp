// Numbers as text and back, independent of the locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::app {

/// The shortest text that reads back as the same double. NaN gives an empty text.
std::string exact_text(double value);

/// Six decimals; NaN gives an empty text. Metres to a micrometre.
std::string micro_text(double value);

/// Six decimals, rounded towards minus infinity, so that a lower bound stays one. NaN gives an empty text.
std::string micro_text_down(double value);

/// The whole text as a double, or nothing. Accepts surrounding blanks and a leading '+'; accepts "nan" and "inf",
/// so that the caller can name them in its message.
std::optional<double> parse_number(std::string_view text);

/// The whole text as a whole number, or nothing.
std::optional<long> parse_whole_number(std::string_view text);

/// The parts between the separators, without surrounding blanks; an empty text has one empty part.
std::vector<std::string> split(std::string_view text, char separator);

/// Without surrounding blanks and carriage returns.
std::string_view trimmed(std::string_view text);

}  // namespace depthgrid::app
