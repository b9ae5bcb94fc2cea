// From the time of an exposure to the robot in the image: joint history, kinematics, padding for time, removal.
#pragma once

#include <span>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/robot/placed_robot.hpp"
#include "depthgrid/robot/robot_removal.hpp"

namespace depthgrid::robot {

struct ExposureSettings {
  RemovalSettings removal;
  /// How far the exposure's time may be from the joints' clock, half the exposure included.
  double time_error_s = 0;
  /// Greatest speeds within that time, rad/s or m/s, one a joint; empty: the model's limits.
  std::vector<double> joint_speeds{};
  /// Greatest accelerations, protective stops included, rad/s^2 or m/s^2, one a joint; empty: not known.
  std::vector<double> joint_accelerations{};
};

/// The robot in one image.
struct ExposedRobot {
  JointsAtTime joints;           ///< where the positions come from
  RobotView view;                ///< for Frame::robot; without robot where the positions are not known
  JointMoment known;             ///< what the history held
  bool measured_motion = false;  ///< the padding for motion comes from the samples around, not from speeds alone
};

/// One camera's robot. The history must outlive it. One thread at a time; allocates in its constructor only.
class RobotAtExposure {
 public:
  /// Throws Error as RobotRemoval does, when the time error, a speed or an acceleration is negative or not finite, or
  /// there is not one a joint. A model without a speed limit needs joint_speeds.
  RobotAtExposure(PlacedRobot robot, const JointHistory& history, const PinholeCamera& camera,
                  std::vector<LinkCapsule> capsules, const ExposureSettings& settings);

  /// The image is exposed about time_s, on the history's clock. `reading`: that image, or null (RobotRemoval::find).
  /// The padding for motion is what the joints moved around that time (JointHistory::greatest_motion()), without
  /// joint_accelerations no more than what they can at joint_speeds within the time error and joints.time_error_s, and
  /// that where the samples do not tell. The view is good until the next call.
  [[nodiscard]] ExposedRobot find(double time_s, const Pose& T_world_camera,
                                  const DepthView* reading = nullptr) noexcept {
    return find(time_s, T_world_camera, reading, history_.now());
  }
  /// As it was answered at that moment of the history.
  [[nodiscard]] ExposedRobot find(double time_s, const Pose& T_world_camera, const DepthView* reading,
                                  const JointMoment& known) noexcept;

  /// As of the last call that found the positions.
  [[nodiscard]] std::span<const Pose> T_world_link() const noexcept { return T_world_link_; }
  [[nodiscard]] std::span<const double> motion_m() const noexcept { return motion_m_; }

 private:
  PlacedRobot robot_;
  const JointHistory& history_;
  ExposureSettings settings_;
  RobotRemoval removal_;
  std::vector<double> q_;
  std::vector<double> moved_;   ///< of each joint
  std::vector<double> window_;  ///< the same by the samples
  std::vector<Pose> T_world_link_;
  std::vector<double> motion_m_;
};

}  // namespace depthgrid::robot
