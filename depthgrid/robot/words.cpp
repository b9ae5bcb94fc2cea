#include "depthgrid/robot/words.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::robot {

std::string_view next_word(std::string_view& rest) noexcept {
  constexpr std::string_view kBlank = " \t\r\n\v\f";
  const std::size_t begin = std::min(rest.find_first_not_of(kBlank), rest.size());
  const std::size_t end = std::min(rest.find_first_of(kBlank, begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::string_view next_line(std::string_view& rest) noexcept {
  const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end + (rest.substr(end, 2) == "\r\n" ? 2 : std::min<std::size_t>(1, rest.size() - end)));
  return line;
}

std::optional<double> finite_number(std::string_view word) noexcept {
  const std::optional<double> number = parse_number<double>(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::string shown(std::string_view text) { return printable_excerpt(text); }

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return result;
}

}  // namespace depthgrid::robot
