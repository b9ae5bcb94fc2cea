#include "depthgrid/sensors/simulated_joints.hpp"

#include <algorithm>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::sensors {

SimulatedJoints::SimulatedJoints(std::shared_ptr<const SimulatedCell> cell, double rate_hz)
    : cell_(std::move(cell)), rate_hz_(rate_hz), q_(cell_->joints()) {
  if (q_.empty()) {
    fail("simulated joints: the cell has no robot");
  }
  if (!(rate_hz > 0 && rate_hz <= 10000)) {
    fail("simulated joints: ", rate_hz, " states a second, must be above 0 and at most 10000");
  }
  info_ = {"simulated joints", "", "this computer", std::nullopt, 0.001};
}

void SimulatedJoints::open() {
  is_open_ = true;
  next_s_ = clock_now_s();
}

Reading SimulatedJoints::next(JointReading& reading, double longest_s) noexcept {
  if (!is_open_) {
    return Reading::failed;
  }
  if (!wait_until(next_s_, longest_s)) {
    return Reading::nothing;
  }
  reading.time_s = clock_now_s();
  cell_->joints_at(reading.time_s - cell_->begin_s(), q_);
  reading.q = q_;
  next_s_ = std::max(next_s_ + 1 / rate_hz_, reading.time_s - 1 / rate_hz_);
  return Reading::got;
}

}  // namespace depthgrid::sensors
