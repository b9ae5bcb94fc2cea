#include "lab/measure/samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace depthgrid::lab {

double Samples::quantile(double q) const {
  // The rank ceil(q n), so that a late call of few is not passed over.
  const auto n = static_cast<double>(count());
  const double rank = std::max(1.0, std::ceil(std::clamp(q, 0.0, 1.0) * n));
  return report::quantile(values_, n > 1 ? (rank - 1) / (n - 1) : 0);
}

double Samples::mean() const {
  return empty() ? std::numeric_limits<double>::quiet_NaN()
                 : std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(count());
}

void Samples::describe(const std::string& key, const std::string& unit, std::map<std::string, double>& numbers) const {
  numbers[key + "_count"] = static_cast<double>(count());
  numbers[key + "_mean_" + unit] = mean();
  numbers[key + "_median_" + unit] = median();
  numbers[key + "_p95_" + unit] = quantile(0.95);
  numbers[key + "_p99_" + unit] = quantile(0.99);
  numbers[key + "_p999_" + unit] = quantile(0.999);
  numbers[key + "_max_" + unit] = largest();
}

}  // namespace depthgrid::lab
