#include "depthgrid/robot/frame_intake.hpp"

#include <algorithm>

#include "depthgrid/core/usable_frame.hpp"

namespace depthgrid::robot {

FrameIntake::FrameIntake(const Rig& rig, const PlacedRobot& robot, const JointHistory& history,
                         const ExposureSettings& settings, const CapsuleOptions& capsules)
    : cameras_(rig.cameras),
      history_(history),
      padding_m_(settings.removal.padding_m),
      report_(rig.cameras.size()),
      frames_(rig.cameras.size()) {
  (void)checked_rig(rig, "the intake");
  const std::vector<LinkCapsule> links = link_capsules(robot.model, capsules);
  for (const RigCamera& camera : rig.cameras) {
    robots_.push_back(std::make_unique<RobotAtExposure>(robot, history, camera.intrinsics, links, settings));
  }
}

Frame FrameIntake::frame(std::size_t camera, const Frame& seen) noexcept {
  return camera < cameras_.size() ? frame(camera, seen, cameras_[camera].T_world_camera) : Frame{};
}

Frame FrameIntake::frame(std::size_t camera, const Frame& seen, const Pose& T_world_camera,
                         const JointMoment& known) noexcept {
  if (camera >= cameras_.size()) {
    return {};
  }
  const ExposedRobot robot = robots_[camera]->find(seen.time_s, T_world_camera, &seen.depth, known);
  const Frame result{seen.depth, robot.view, seen.time_s};
  const bool removed = robot.view.near_m != nullptr && why_unusable(result, cameras_[camera]) == nullptr;
  report_[camera] = {robot.joints, removed, removed ? robot.view.blind_m : 0.0, robot.known};
  return result;
}

std::span<const Frame> FrameIntake::frames(std::span<const Frame> seen) noexcept {
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    frames_[k] = k < seen.size() ? frame(k, seen[k]) : Frame{};
  }
  return frames_;
}

std::optional<double> FrameIntake::missing_padding_m(std::size_t camera, double depth_m) const noexcept {
  if (camera >= cameras_.size() || !cameras_[camera].margins) {
    return std::nullopt;
  }
  const PinholeCamera& image = cameras_[camera].intrinsics;
  double along_ray = 1;
  for (const double u_px : {0, image.width_px}) {
    for (const double v_px : {0, image.height_px}) {
      along_ray = std::max(along_ray, deproject(image, {u_px, v_px, 1.0}).norm());
    }
  }
  return std::max(0.0, along_ray * depth_margin_m(cameras_[camera].margins->sensor, depth_m) - padding_m_);
}

}  // namespace depthgrid::robot
