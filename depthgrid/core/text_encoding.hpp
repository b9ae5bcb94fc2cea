// What text editors put before a text. Not part of the installed headers. Internal.
#pragma once

#include <string>
#include <string_view>

namespace depthgrid {

/// `text` without the byte order mark of UTF-8, which Windows programs write; lines may end in "\r\n" or "\n" with
/// every reader. Throws Error, beginning with `context`, on UTF-16 or UTF-32 with or without a mark, which the readers
/// here do not know.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text, std::string_view context);

}  // namespace depthgrid
