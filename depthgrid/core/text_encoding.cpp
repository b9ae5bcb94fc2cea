#include "depthgrid/core/text_encoding.hpp"

#include "depthgrid/core/error.hpp"

namespace depthgrid {

std::string_view without_byte_order_mark(std::string_view text, std::string_view context) {
  using std::string_view_literals::operator""sv;
  if (text.starts_with("\xEF\xBB\xBF"sv)) {
    return text.substr(3);
  }
  // Without a mark the first character, always an ASCII one, has zeros beside it.
  const bool zero_first = text.size() > 1 && text[0] == '\0' && text[1] != '\0';
  const bool zero_second = text.size() > 1 && text[0] != '\0' && text[1] == '\0';
  if (text.starts_with("\xFF\xFE"sv) || text.starts_with("\xFE\xFF"sv) || text.starts_with("\0\0\xFE\xFF"sv) ||
      zero_first || zero_second) {
    fail(context,
         "is UTF-16 or UTF-32 text, must be UTF-8 or ASCII; save it as UTF-8 (PowerShell: Out-File -Encoding utf8)");
  }
  return text;
}

}  // namespace depthgrid
