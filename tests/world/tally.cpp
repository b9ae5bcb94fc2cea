#include "world/tally.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace depthgrid::world {

Counts& Counts::operator+=(const Counts& other) {
  std::vector<std::int64_t> added;
  added.reserve(16);
  each_count(other, [&added](const char* /*name*/, std::int64_t count) { added.push_back(count); });
  auto next = added.begin();
  each_count(*this, [&next](const char* /*name*/, std::int64_t& count) { count += *next++; });
  std::transform(ratios.begin(), ratios.end(), other.ratios.begin(), ratios.begin(), std::plus<>());
  largest_excess_m = std::max(largest_excess_m, other.largest_excess_m);
  return *this;
}

double Counts::median_ratio() const {
  const auto all = std::accumulate(ratios.begin(), ratios.end(), std::int64_t{0});
  std::int64_t seen = 0;
  for (std::size_t i = 0; i < kRatios && all > 0; ++i) {
    seen += ratios.at(i);
    if (2 * seen >= all) {
      return static_cast<double>(i) / (kRatios - 1);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void Tally::note(const std::string& line) {
  if (lines.size() < kMaxLines) {
    lines.push_back(line);
  }
}

Tally& Tally::operator+=(const Tally& other) {
  for (const auto& [name, counts] : other.rows) {
    rows[name] += counts;
  }
  for (const std::string& line : other.lines) {
    note(line);
  }
  return *this;
}

}  // namespace depthgrid::world
