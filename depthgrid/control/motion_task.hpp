// What the end effector shall do, as rows for the controller.
#pragma once

#include "depthgrid/control/saturation.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::control {

/// The end effector at the beginning of a period.
struct EndEffector {
  Pose T_world_tip = Pose::Identity();
  TaskJacobian jacobian;  ///< 6 x n: velocity of the tip's origin above the angular velocity, world frame
  double time_s = 0;
};

/// Asked once a period, by the thread that calls the loop's cycle(). Must not throw; should neither allocate nor lock.
class MotionTask {
 public:
  MotionTask() = default;
  virtual ~MotionTask() = default;
  MotionTask(const MotionTask&) = delete;
  MotionTask& operator=(const MotionTask&) = delete;

  /// At most kMaxTaskRows rows. The first three are the velocity of the tip's origin, world frame, since the repulsion
  /// is added there: as a rule the first three of `tip.jacobian`, or all six.
  [[nodiscard]] virtual Task rows(const EndEffector& tip) noexcept = 0;
};

}  // namespace depthgrid::control
