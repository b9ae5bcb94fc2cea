// The depth grid map of the letter's section V behind one type, whatever its storage.
#pragma once

#include <variant>

#include "depthgrid/grid/closed_form_map.hpp"

namespace depthgrid::grid {

/// Any storage of the map. Evaluation visits it once a call, not once a cell.
using DepthGridMap = std::variant<ClosedFormMap>;

}  // namespace depthgrid::grid
