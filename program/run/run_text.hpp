// What `depthgrid run` says to people: a line while it runs, and a summary.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/monitor/monitor.hpp"

namespace depthgrid::program {

/// One line: stop or go, the least distance and why, the age of each camera's image.
[[nodiscard]] std::string status_line(const monitor::CellAnswer& answer, const monitor::Names& names);

/// Lines for the end. `outputs`: what each output of the monitor is called; `stops`: the lines of the last stops.
[[nodiscard]] std::string summary(const monitor::Monitor& monitor, const std::vector<std::string>& outputs,
                                  const std::vector<std::string>& stops);

}  // namespace depthgrid::program
