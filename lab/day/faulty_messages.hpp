// What a device sends instead of its image or its joint state while it has a fault.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "lab/day/fault_plan.hpp"

namespace depthgrid::lab {

/// An image in millimetres, or joint positions.
struct DeviceMessage {
  double time_s = 0;  ///< as it is stamped, by the clock
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint16_t> units;
  std::vector<double> q;
};

/// One device's. - Threads: one.
class FaultyMessages {
 public:
  /// `delay_s`: by how much messages are late while they are delayed.
  explicit FaultyMessages(double delay_s) : delay_s_(delay_s) {}

  /// What leaves the device at now_s, in this order, when `message` was measured and `fault` holds. Without fault: it
  /// alone.
  [[nodiscard]] std::vector<DeviceMessage> pass(const DeviceMessage& message, std::optional<DeviceFault> fault,
                                                double now_s);

 private:
  double delay_s_;
  std::deque<DeviceMessage> held_;
  std::optional<DeviceMessage> last_good_;
  std::optional<DeviceFault> before_;
};

}  // namespace depthgrid::lab
