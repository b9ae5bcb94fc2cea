// Which machine a figure was taken on.
#pragma once

#include "report/machine.hpp"

namespace depthgrid::bench {

using report::machine_line;

}  // namespace depthgrid::bench
