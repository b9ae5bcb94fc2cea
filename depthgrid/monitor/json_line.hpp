// An answer as one line of JSON.
#pragma once

#include <string>

#include "depthgrid/monitor/cell_answer.hpp"

namespace depthgrid::monitor {

/// Without a newline. Metres, seconds; what is not known is null; distances are rounded down to a micrometre. The
/// fields stand in docs/run.md.
[[nodiscard]] std::string json_line(const CellAnswer& answer, const Names& names);

}  // namespace depthgrid::monitor
