// Which machine a figure was taken on.
#pragma once

#include <string>
#include <string_view>

namespace depthgrid::report {

/// One line: processor, cores, instruction sets, compiler, date. For the head of a table. `used`: how many of the
/// cores.
[[nodiscard]] std::string machine_line(std::string_view used = "one");

}  // namespace depthgrid::report
