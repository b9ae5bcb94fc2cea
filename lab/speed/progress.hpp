// Progress of a long run on standard error, with the time left.
#pragma once

#include <chrono>
#include <string>

namespace depthgrid::lab {

/// Steps have expected costs; the time left follows from how long the steps so far took for theirs.
class Progress {
 public:
  explicit Progress(double expected_total_s) : expected_total_s_(expected_total_s) {}
  /// Says what begins now. `expected_s` is the cost of the step that ends with the next call.
  void step(const std::string& what, double expected_s);
  void finish();
  [[nodiscard]] double elapsed_s() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double expected_total_s_;
  double expected_done_s_ = 0;
  double expected_current_s_ = 0;
};

}  // namespace depthgrid::lab
