// From depth images to frames: the robot is found in each image where it was at the time of the exposure. Needs joint
// positions over time, no controller.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_at_exposure.hpp"

namespace depthgrid::robot {

/// What became of the robot in a camera's last image.
struct IntakeReport {
  JointsAtTime joints;         ///< of the exposure, or why they are not known
  bool robot_removed = false;  ///< false: the robot is its own obstacle in this image, or nobody can use it
  double blind_m = 0;          ///< RobotView::blind_m of what was removed; 0 where nothing was
  JointMoment known{};         ///< what the history held
};

/// The robot in all cameras of a rig.
/// - Takes: depth images, seconds on the history's clock; poses camera to world.
/// - Gives: frames with the robot in them, good until the camera's next one.
/// - Errors: the constructor throws Error; report() says where the robot could not be removed.
/// - Threads: each camera may have one of its own; frames() counts as all of them.
/// - Allocates in its constructor only.
class FrameIntake {
 public:
  /// The history must outlive it. Throws Error as link_capsules() and RobotAtExposure do.
  FrameIntake(const Rig& rig, const PlacedRobot& robot, const JointHistory& history, const ExposureSettings& settings,
              const CapsuleOptions& capsules = {});

  /// One camera's image with the robot in it. `seen`: depth, and the time on the history's clock; its robot is not
  /// looked at. The camera stands where the rig says, or, one that moves, where it was at the exposure. Where the joint
  /// positions of the exposure are not known the robot is not removed, and so is its own obstacle. The frame points
  /// into this object and to the image; good until the camera's next one. A camera that the rig lacks gives no image.
  [[nodiscard]] Frame frame(std::size_t camera, const Frame& seen) noexcept;
  [[nodiscard]] Frame frame(std::size_t camera, const Frame& seen, const Pose& T_world_camera) noexcept {
    return frame(camera, seen, T_world_camera, history_.now());
  }
  /// As at that moment of the history.
  [[nodiscard]] Frame frame(std::size_t camera, const Frame& seen, const Pose& T_world_camera,
                            const JointMoment& known) noexcept;

  /// All cameras that do not move, in the rig's order, each at its own time; those after the last of `seen` give no
  /// image.
  [[nodiscard]] std::span<const Frame> frames(std::span<const Frame> seen) noexcept;

  /// Of each camera's last image, in the rig's order.
  [[nodiscard]] std::span<const IntakeReport> report() const noexcept { return report_; }

  /// By how much the padding is less than the camera's margin for readings at this depth, up to the image's corners:
  /// more than 0, and the robot may be its own obstacle there. Nothing where the rig states no margins of the camera.
  [[nodiscard]] std::optional<double> missing_padding_m(std::size_t camera, double depth_m) const noexcept;

 private:
  std::vector<RigCamera> cameras_;
  const JointHistory& history_;
  double padding_m_;
  std::vector<std::unique_ptr<RobotAtExposure>> robots_;
  std::vector<IntakeReport> report_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::robot
