// The newest image of one camera, prepared once per frame for all control points. Internal.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::grid {

/// Dense images of one camera. All buffers are allocated by the constructor.
class Observation {
 public:
  /// With `margins` the free depth g is prepared as well (corrected); without, only what the letter reads.
  Observation(const RigCamera& camera, const SensorMargin* margins);

  /// Takes a frame. False when it is unusable; then nothing is measured anywhere.
  bool update(const Frame& frame) noexcept;

  /// Measured depth, 0 = no measurement.
  [[nodiscard]] const DepthImage& measured_m() const noexcept { return measured_m_; }
  /// What the letter's cases read: the measured depth, or at a removed robot's pixel the depth up to which the robot
  /// itself excludes an obstacle (the far end of its interval). 0 = no measurement.
  [[nodiscard]] const DepthImage& removed_m() const noexcept { return removed_m_; }
  /// 1 where the robot was removed (both variants): the measured depth lies inside the robot's interval. A hand in
  /// front of the robot does not, so it stays.
  [[nodiscard]] const std::vector<std::uint8_t>& is_robot() const noexcept { return is_robot_; }
  /// Depth up to which each pixel's frustum is free (corrected only).
  [[nodiscard]] const DepthImage& free_m() const noexcept { return free_.image(); }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  [[nodiscard]] bool present() const noexcept { return present_; }

 private:
  void remove_robot(const RobotView& robot) noexcept;

  RigCamera camera_;
  bool with_free_depth_;
  DepthImage measured_m_;
  DepthImage removed_m_;
  std::vector<std::uint8_t> is_robot_;
  FreeDepth free_;
  double time_s_ = 0;
  bool present_ = false;
};

}  // namespace depthgrid::grid
