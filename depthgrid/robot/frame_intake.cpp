#include "depthgrid/robot/frame_intake.hpp"

#include <algorithm>

#include "depthgrid/robot/link_capsules.hpp"

namespace depthgrid::robot {

FrameIntake::FrameIntake(const Rig& rig, const RobotModel& model, const JointHistory& history,
                         const ExposureSettings& settings)
    : frames_(rig.cameras.size()) {
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  for (const RigCamera& camera : rig.cameras) {
    T_world_camera_.push_back(camera.T_world_camera);
    robots_.push_back(std::make_unique<RobotAtExposure>(model, history, camera.intrinsics, capsules, settings));
  }
}

std::span<const Frame> FrameIntake::frames(std::span<const DepthView> images, double time_s) noexcept {
  const std::size_t count = std::min(images.size(), frames_.size());
  std::fill(frames_.begin(), frames_.end(), Frame{});
  for (std::size_t k = 0; k < count; ++k) {
    frames_[k] = {images[k], robots_[k]->find(time_s, T_world_camera_[k], &images[k]).view, time_s};
  }
  return frames_;
}

}  // namespace depthgrid::robot
