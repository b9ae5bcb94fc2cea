#include "depthgrid/robot/robot_at_exposure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/motion_padding.hpp"

namespace depthgrid::robot {

RobotAtExposure::RobotAtExposure(PlacedRobot robot, const JointHistory& history, const PinholeCamera& camera,
                                 std::vector<LinkCapsule> capsules, const ExposureSettings& settings)
    : robot_(std::move(robot)),
      history_(history),
      settings_(settings),
      removal_(camera, std::move(capsules), settings.removal),
      q_(robot_.model.joints().size()),
      moved_(robot_.model.joints().size()),
      window_(robot_.model.joints().size()),
      T_world_link_(robot_.model.links().size(), Pose::Identity()),
      motion_m_(removal_.capsules().size()) {
  const RobotModel& model = robot_.model;
  (void)pose_from_matrix(robot_.T_world_base.matrix(), "T_world_base");  // throws where it is not rigid
  if (!(std::isfinite(settings_.time_error_s) && settings_.time_error_s >= 0)) {
    fail(model.source(), ": the error of time is ", settings_.time_error_s, " s, must be finite and not negative");
  }
  if (settings_.joint_speeds.empty()) {
    for (const Joint& joint : model.joints()) {
      settings_.joint_speeds.push_back(joint.max_speed);
    }
  }
  if (settings_.joint_speeds.size() != model.joints().size()) {
    fail(model.source(), ": ", settings_.joint_speeds.size(), " joint speeds for ", model.joints().size(), " joints");
  }
  for (std::size_t j = 0; j < settings_.joint_speeds.size(); ++j) {
    if (!(std::isfinite(settings_.joint_speeds[j]) && settings_.joint_speeds[j] >= 0)) {
      fail(model.source(), ": joint '", model.joints()[j].name, "': its speed is ", settings_.joint_speeds[j],
           ", must be finite and not negative; state joint_speeds where the model has no limit");
    }
  }
  std::vector<double>& accelerations = settings_.joint_accelerations;
  if (accelerations.empty()) {
    accelerations.assign(model.joints().size(), std::numeric_limits<double>::infinity());
  } else if (accelerations.size() != model.joints().size()) {
    fail(model.source(), ": ", accelerations.size(), " joint accelerations for ", model.joints().size(), " joints");
  } else {
    for (std::size_t j = 0; j < accelerations.size(); ++j) {
      if (!(std::isfinite(accelerations[j]) && accelerations[j] >= 0)) {
        fail(model.source(), ": joint '", model.joints()[j].name, "': its acceleration is ", accelerations[j],
             ", must be finite and not negative; leave joint_accelerations empty where they are not known");
      }
    }
  }
}

ExposedRobot RobotAtExposure::find(double time_s, const Pose& T_world_camera, const DepthView* reading,
                                   const JointMoment& known) noexcept {
  ExposedRobot result;
  result.known = known;
  result.joints = history_.at(time_s, q_, known);
  if (!result.joints.known() || !robot_.link_poses(q_, T_world_link_)) {
    return result;
  }
  const double error_s = settings_.time_error_s + result.joints.time_error_s;
  result.measured_motion = history_.greatest_motion(time_s, settings_.time_error_s, q_, settings_.joint_speeds,
                                                    settings_.joint_accelerations, window_, known);
  for (std::size_t j = 0; j < moved_.size(); ++j) {
    const double at_most = settings_.joint_speeds[j] * error_s;
    // Without an acceleration, what a joint may do between two samples counts no more than its speed within the error.
    const double measured =
        std::isfinite(settings_.joint_accelerations[j]) ? window_[j] : std::min(at_most, window_[j]);
    moved_[j] = result.measured_motion ? measured : at_most;
  }
  motion_padding(robot_.model, removal_.capsules(), T_world_link_, moved_, 1.0, motion_m_);
  result.view = removal_.find(T_world_link_, T_world_camera, motion_m_, reading);
  return result;
}

}  // namespace depthgrid::robot
