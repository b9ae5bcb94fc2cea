#include "report/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::report {

double quantile(std::vector<double> values, double q) {
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const long rank = std::lround(std::clamp(q, 0.0, 1.0) * static_cast<double>(values.size() - 1));
  const auto at = values.begin() + rank;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace depthgrid::report
