// Which machine a figure was taken on, and when.
#pragma once

#include <string>
#include <string_view>

namespace depthgrid::report {

/// Now, in UTC: "2026-11-23" and "2026-11-23T08:30:00Z".
[[nodiscard]] std::string today();
[[nodiscard]] std::string now_utc();

/// One line: processor, cores, instruction sets, compiler, date. For the head of a table. `used`: how many of the
/// cores.
[[nodiscard]] std::string machine_line(std::string_view used = "one");

}  // namespace depthgrid::report
