// Which machine a figure was taken on.
#pragma once

#include <string>

namespace depthgrid::report {

/// One line: processor, cores, instruction sets, compiler, date. For the head of a table.
[[nodiscard]] std::string machine_line();

}  // namespace depthgrid::report
