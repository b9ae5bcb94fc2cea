// Where the ball of the recording kinect3_ball is in every frame.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace depthgrid::lab {

/// The ball as one camera alone sees it.
struct BallFit {
  Eigen::Vector3d centre_world;
  double radius_m = 0;
};

struct BallTrack {
  double radius_m = 0;
  std::map<int, Eigen::Vector3d> centre_world;         ///< by frame number
  std::map<int, std::map<std::string, BallFit>> fits;  ///< by frame number and camera; none where it is not seen

  [[nodiscard]] std::optional<BallFit> fit(int frame, const std::string& camera) const;
};

/// Reads ball.json. Throws Error that names the file.
BallTrack load_ball_track(const std::filesystem::path& file);

}  // namespace depthgrid::lab
