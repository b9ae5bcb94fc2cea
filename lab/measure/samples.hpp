// Measured times and errors of one row.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "report/statistics.hpp"

namespace depthgrid::lab {

class Samples {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] std::size_t count() const { return values_.size(); }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// NaN when there are none, as all figures. Percentiles are a measured value that at least the share q does not
  /// exceed.
  [[nodiscard]] double mean() const;
  [[nodiscard]] double quantile(double q) const;
  [[nodiscard]] double median() const { return quantile(0.5); }
  [[nodiscard]] double largest() const { return quantile(1); }

  /// Writes count, mean, median, 95th, 99th and 99.9th percentile and maximum as "<key>_<what>_<unit>".
  void describe(const std::string& key, const std::string& unit, std::map<std::string, double>& numbers) const;

 private:
  std::vector<double> values_;
};

}  // namespace depthgrid::lab
