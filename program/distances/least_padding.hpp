// depthgrid distances --least-padding: which padding the robot of a recording needs.
#pragma once

#include <string>

#include "program/distances/distances_plan.hpp"

namespace depthgrid::program {

/// A table of the links, who decides, and what to state. The plan asks for it. Throws Error where a file is broken or
/// the plan's rho is too small.
[[nodiscard]] std::string least_padding_text(DistancesPlan& plan);

}  // namespace depthgrid::program
