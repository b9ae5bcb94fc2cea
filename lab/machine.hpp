// Which machine a figure was taken on.
#pragma once

#include "report/machine.hpp"

namespace depthgrid::lab {

using report::machine_line;

}  // namespace depthgrid::lab
