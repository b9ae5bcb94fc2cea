#include "depthgrid/core/printable_text.hpp"

#include <cstddef>
#include <cstdint>

namespace depthgrid {
namespace {

struct Character {
  std::size_t bytes = 1;
  bool prints = false;
};

/// U+2028 and U+2029 end a line, the others turn the direction of writing.
bool steers(std::uint32_t code) noexcept {
  return code == 0x2028 || code == 0x2029 || code == 0x200E || code == 0x200F || code == 0x061C ||
         (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

/// The first character of a text that is not empty: RFC 3629, table 3-7 of the Unicode standard.
Character first_character(std::string_view text) noexcept {
  const auto byte = [text](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) {
    return {1, lead >= 0x20 && lead != 0x7F};
  }
  const std::size_t bytes = lead < 0xC2 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 1;
  if (bytes == 1 || text.size() < bytes) {
    return {};
  }
  std::uint32_t code = lead & (0x7FU >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) {
      return {};
    }
    code = (code << 6U) | (byte(k) & 0x3FU);
  }
  const bool is_overlong = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
  if (is_overlong || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) {
    return {};
  }
  return {bytes, code >= 0xA0 && !steers(code)};
}

void append_escaped(std::string& result, char c) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto code = static_cast<unsigned char>(c);
  switch (c) {
    case '\t':
      result += "\\t";
      break;
    case '\n':
      result += "\\n";
      break;
    case '\r':
      result += "\\r";
      break;
    default:
      result += "\\x";
      result += kDigits[code >> 4U];
      result += kDigits[code & 15U];
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_character(text);
    for (const char c : text.substr(0, character.bytes)) {
      if (character.prints) {
        result += c;
      } else {
        append_escaped(result, c);
      }
    }
    text.remove_prefix(character.bytes);
  }
  return result;
}

std::string printable_excerpt(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() <= kLongest) {
    return printable(text);
  }
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
    --end;  // not inside a UTF-8 character
  }
  return printable(text.substr(0, end)) + "...";
}

bool is_printable(std::string_view text) {
  while (!text.empty()) {
    const Character character = first_character(text);
    if (!character.prints) {
      return false;
    }
    text.remove_prefix(character.bytes);
  }
  return true;
}

}  // namespace depthgrid
