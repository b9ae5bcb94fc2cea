// From depth images to frames: the robot is found in each image where it was at the time of the exposure.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/robot/robot_at_exposure.hpp"

namespace depthgrid::robot {

/// The robot in all cameras of a rig that do not move. One thread; allocates in its constructor only.
class FrameIntake {
 public:
  /// Model and history must outlive it. Throws Error as RobotAtExposure does.
  FrameIntake(const Rig& rig, const RobotModel& model, const JointHistory& history, const ExposureSettings& settings);

  /// One image a camera, in the rig's order, all exposed about time_s on the history's clock. The frames point into
  /// this object and to the images; good until the next call. Where the joint positions of the exposure are not known
  /// the robot is not removed, and so is its own obstacle.
  [[nodiscard]] std::span<const Frame> frames(std::span<const DepthView> images, double time_s) noexcept;

 private:
  std::vector<Pose> T_world_camera_;
  std::vector<std::unique_ptr<RobotAtExposure>> robots_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::robot
