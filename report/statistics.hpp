// Figures of samples.
#pragma once

#include <vector>

namespace depthgrid::report {

/// The q-quantile, 0 <= q <= 1: the value nearest to rank q (n - 1) of n, so always one that was measured. NaN when
/// there are none.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace depthgrid::report
