// Tables and numbers of report.md.
#pragma once

#include <string>
#include <vector>

namespace depthgrid::experiments {

/// A Markdown table; every row has as many cells as `head`. Throws Error when one has not.
[[nodiscard]] std::string markdown_table(const std::vector<std::string>& head,
                                         const std::vector<std::vector<std::string>>& rows);

/// With so many digits after the point; "-" when not finite.
[[nodiscard]] std::string fixed(double value, int digits = 0);

/// A share as "12.3 %".
[[nodiscard]] std::string percent(double share, int digits = 1);

}  // namespace depthgrid::experiments
