// A rig: calibrated depth cameras in one world frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/distortion.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid {

/// One calibrated depth camera. The intrinsics are in the pixel-edge convention.
struct RigCamera {
  std::string id;
  PinholeCamera intrinsics;
  Distortion distortion{};
  double metres_per_unit = 0.001;  ///< of 16-bit depth images
  MeasurementRule rule{};
  Pose T_world_camera = Pose::Identity();
  std::string sensor{};                    ///< the built-in sensor model that `margins` started from; empty: none
  std::optional<CameraMargins> margins{};  ///< none: nothing was said about the camera's errors
};

/// Cameras with distinct ids. T_floor_world maps world to a frame with z up and z = 0 on the floor.
struct Rig {
  std::string name;
  std::vector<RigCamera> cameras;
  std::optional<Pose> T_floor_world{};
};

/// Largest accepted coordinate of a camera, metres: beyond it double rounding outgrows the guards of the evaluators.
/// Move the world's origin near the cameras instead.
inline constexpr double kLargestTranslation = 1e5;

/// Throws Error unless there is at least one camera, ids are non-empty and distinct, every camera is valid (a sensor
/// model needs margins, too), and poses are rotations (to kRotationTolerance) with translations of at most
/// kLargestTranslation.
void validate(const Rig& rig);

/// The rig for one that reads depth images and measures by it: valid, free of lens distortion (images must be
/// undistorted first), and with exact rotations: one that is off by up to the tolerance would scale distances. Throws
/// Error otherwise; `reader` begins the message about distortion.
[[nodiscard]] Rig checked_rig(Rig rig, const char* reader);

/// C++ that makes the same rig, to the bit: for a report that can be run again.
[[nodiscard]] std::string to_string(const Rig& rig);

/// The margins of all cameras, in the rig's order. Throws Error that names a camera without.
std::vector<CameraMargins> camera_margins(const Rig& rig);

/// Index of the camera called `id`. Throws Error that lists the ids there are.
std::size_t camera_index(const Rig& rig, const std::string& id);

}  // namespace depthgrid
