// Cameras as calibration files of other programs describe them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/distortion.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::program {

/// What one camera's entry says; a file says nothing of sensors and of the unit of depth.
struct ImportedCamera {
  std::string id;      ///< the file's name for it, or the file's own without its ending
  std::string format;  ///< for instance "ROS camera_info"
  PinholeCamera intrinsics;
  Distortion distortion;
  /// Where the file says where the camera stands: in the world, or (Kalibr) in the camera before it.
  std::optional<Pose> T_world_camera;
  std::optional<Pose> T_previous_camera;
};

/// What files leave open and the reading needs.
struct ImportOptions {
  bool rectified = false;  ///< ROS: the images are rectified ones, so P holds instead of K and the distortion
  std::string depth_mode;  ///< Azure Kinect: which part of the sensor the images are; empty: not said
};

/// The cameras of a text, whose format is recognised by what stands in it: ROS camera_info (as camera_calibration
/// writes it, or a printed message), Kalibr camchain, Open3D intrinsic, camera parameters or trajectory, Azure Kinect
/// calibration. `name` stands for the file, in messages and for a camera without a name. Throws Error that names the
/// place; UsageError where an option is needed.
[[nodiscard]] std::vector<ImportedCamera> import_cameras(std::string_view text, const std::string& name,
                                                         const ImportOptions& options);

}  // namespace depthgrid::program
