// Where a camera that moves was in each frame, as its rig file says. Internal.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/files/trajectory.hpp"

namespace depthgrid::files {

/// The trajectory or the pose files of one camera. Immutable.
class CameraPoses {
 public:
  /// Reads the trajectory; pose files are read when they are asked for. Throws Error.
  CameraPoses(CameraTrack track, std::filesystem::path folder, std::optional<double> gap_s);

  /// T_world_camera of a frame. `time_s` is not used with pose files. Throws Error that names the file and what is
  /// missing.
  [[nodiscard]] Pose at(int number, std::optional<double> time_s) const;

  /// The file that at() looks into.
  [[nodiscard]] std::filesystem::path file(int number) const;

 private:
  CameraTrack track_;
  std::filesystem::path folder_;
  std::optional<double> gap_s_;
  std::vector<StampedPose> trajectory_;
};

}  // namespace depthgrid::files
