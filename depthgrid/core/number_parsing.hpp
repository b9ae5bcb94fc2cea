// Numbers in text, independent of the locale. Not part of the installed headers. Internal.
#pragma once

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace depthgrid {

/// Without the blanks and carriage returns around it; a view into the same text, even where nothing is left.
constexpr std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view kBlank = " \t\r";
  text.remove_prefix(text.find_first_not_of(kBlank) == std::string_view::npos ? text.size()
                                                                              : text.find_first_not_of(kBlank));
  return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

/// The whole text, without blanks around it, as a number, or nothing. A leading '+' is accepted, and of a
/// floating-point number "nan" and "inf", so that the caller can name them in its message.
template <class Number>
std::optional<Number> parse_number(std::string_view text) noexcept {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional<Number>(number) : std::nullopt;
}

/// The shortest text that parse_number() reads as the same double: "nan" and "inf" too.
inline std::string number_text(double value) {
  std::array<char, 32> digits{};  // enough for any double
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace depthgrid
