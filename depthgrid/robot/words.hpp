// Words of a text, as the files of robots separate them. Internal.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace depthgrid::robot {

/// Takes the next word, between blanks and line ends, off the front of `rest`; empty when there is none.
std::string_view next_word(std::string_view& rest) noexcept;

/// Takes the next line off the front of `rest`, without its end (LF, CRLF or CR).
std::string_view next_line(std::string_view& rest) noexcept;

/// The whole word as a finite number.
std::optional<double> finite_number(std::string_view word) noexcept;

/// As it may stand in a message: one line that prints, some 60 characters.
std::string shown(std::string_view text);

std::string lower_case(std::string_view text);

}  // namespace depthgrid::robot
