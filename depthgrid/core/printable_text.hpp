// Text of unknown origin made fit for a terminal. Not part of the installed headers. Internal.
#pragma once

#include <string>
#include <string_view>

namespace depthgrid {

/// UTF-8 with everything that could steer a terminal written out: control characters (C0, DEL, C1), those that turn the
/// direction of writing or end a line, and bytes that are no UTF-8 become "\x1b", a byte each; tab, newline and
/// carriage return "\t", "\n", "\r". All else stays as it is, backslashes too.
[[nodiscard]] std::string printable(std::string_view text);

/// The same, cut off after some 60 bytes: for messages that quote a value.
[[nodiscard]] std::string printable_excerpt(std::string_view text);

/// Whether printable() would leave it as it is.
[[nodiscard]] bool is_printable(std::string_view text);

}  // namespace depthgrid
