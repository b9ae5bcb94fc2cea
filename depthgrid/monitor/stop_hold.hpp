// A stop that lasts a while, so that nothing moves in jerks where distances flicker about the limit. Internal.
#pragma once

#include <limits>

namespace depthgrid::monitor {

class StopHold {
 public:
  explicit StopHold(double hold_s) noexcept : hold_s_(hold_s) {}

  /// Whether it is a stop at now_s. `cause`: there is a reason just now.
  [[nodiscard]] bool look(bool cause, double now_s) noexcept {
    cause_s_ = cause ? now_s : cause_s_;
    clear_s_ = cause ? 0 : now_s - cause_s_;
    return cause || clear_s_ < hold_s_;
  }
  /// Since the last reason; 0 while there is one.
  [[nodiscard]] double clear_s() const noexcept { return clear_s_; }

 private:
  double hold_s_;
  double cause_s_ = -std::numeric_limits<double>::infinity();
  double clear_s_ = 0;
};

}  // namespace depthgrid::monitor
