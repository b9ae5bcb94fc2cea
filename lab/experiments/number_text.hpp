// Numbers of report.md.
#pragma once

#include <string>

namespace depthgrid::experiments {

/// With so many digits after the point; "-" when not finite.
[[nodiscard]] std::string fixed(double value, int digits = 0);

/// A share as "12.3 %".
[[nodiscard]] std::string percent(double share, int digits = 1);

}  // namespace depthgrid::experiments
