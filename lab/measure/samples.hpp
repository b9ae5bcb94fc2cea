// Measured times and errors of one row.
#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>
#include <map>
#include <string>
#include <vector>

namespace depthgrid::lab {

/// CPU time of this thread in seconds: what other programs take of the core does not count.
[[nodiscard]] inline double cpu_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU time of a call.
template <class Call>
[[nodiscard]] double timed_s(Call&& call) {
  const double start_s = cpu_time_s();
  call();
  return cpu_time_s() - start_s;
}

/// Wall clock since construction: bounds the length of a run.
class Stopwatch {
 public:
  [[nodiscard]] double elapsed_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class Samples {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] std::size_t count() const { return values_.size(); }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// NaN when there are none.
  [[nodiscard]] double mean() const;
  /// The value below which the share q lies, 0 <= q <= 1 (nearest rank); NaN when there are none.
  [[nodiscard]] double quantile(double q) const;
  [[nodiscard]] double median() const { return quantile(0.5); }
  [[nodiscard]] double largest() const { return quantile(1); }

  /// Writes count, mean, median, 95th, 99th and 99.9th percentile and maximum as "<key>_<what>_<unit>".
  void describe(const std::string& key, const std::string& unit, std::map<std::string, double>& numbers) const;

 private:
  std::vector<double> values_;
};

}  // namespace depthgrid::lab
