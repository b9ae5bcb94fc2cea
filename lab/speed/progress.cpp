#include "lab/speed/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace depthgrid::lab {

double Progress::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::step(const std::string& what, double expected_s) {
  expected_done_s_ += expected_current_s_;
  expected_current_s_ = expected_s;
  const double share = std::min(1.0, expected_done_s_ / expected_total_s_);
  // Until something has been done the plan is all there is.
  const double pace = expected_done_s_ > 0.02 * expected_total_s_ ? elapsed_s() / expected_done_s_ : 1.0;
  const double left_s = std::max(0.0, expected_total_s_ - expected_done_s_) * pace;
  std::fprintf(stderr, "%3.0f %%, about %.0f:%02d min left: %s\n", 100 * share, std::floor(left_s / 60),
               static_cast<int>(left_s) % 60, what.c_str());
}

void Progress::finish() { std::fprintf(stderr, "done in %.1f min\n", elapsed_s() / 60); }

}  // namespace depthgrid::lab
