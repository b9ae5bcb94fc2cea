#include "lab/measure/samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace depthgrid::lab {

double Samples::mean() const {
  return empty() ? std::numeric_limits<double>::quiet_NaN()
                 : std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(count());
}

double Samples::quantile(double q) const {
  if (empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  std::vector<double> sorted = values_;
  const double rank = std::ceil(q * static_cast<double>(count()));
  const auto at = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[static_cast<std::size_t>(at)];
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
