// The robot as the controller sees it: joint state in, position command out.
#pragma once

#include "depthgrid/control/joints.hpp"

namespace depthgrid::control {

struct JointState {
  JointVector position_rad;
  JointVector velocity_rad_s;
  double time_s = 0;  ///< of the measurement; on the cameras' clock where a history is fed with it
};

/// Where the joints shall be one period from now.
struct JointCommand {
  JointVector position_rad;
  JointVector velocity_rad_s;  ///< with which they get there; a feed-forward
};

/// A real arm's driver or a simulated one. Called by one thread, once a period; neither call may throw.
class RobotPort {
 public:
  RobotPort() = default;
  virtual ~RobotPort() = default;
  RobotPort(const RobotPort&) = delete;
  RobotPort& operator=(const RobotPort&) = delete;

  /// The newest state; false when there is none, then `state` is untouched.
  [[nodiscard]] virtual bool read(JointState& state) noexcept = 0;
  /// False when the robot did not take the command.
  [[nodiscard]] virtual bool write(const JointCommand& command) noexcept = 0;
};

}  // namespace depthgrid::control
