// Recorded human motion as files in Acclaim's format hold it: the skeleton (.asf) and its joint angles (.amc).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::simulation {

/// Metres and radians, y up, in the frame of the recording.
struct MocapBone {
  std::string name;
  std::optional<std::size_t> parent;                   ///< an earlier bone; none: starts at the root
  Eigen::Vector3d along_m = Eigen::Vector3d::Zero();   ///< from start to end when all angles are zero
  Eigen::Vector3d axis_rad = Eigen::Vector3d::Zero();  ///< of the frame in which its angles turn: about x, y, z
  std::vector<int> turns;  ///< which of its angles a frame gives, in this order: 0, 1, 2 for x, y, z
};

struct MocapSkeleton {
  std::vector<MocapBone> bones;  ///< parents before children
  double metres_per_unit = 1;
  bool degrees = true;  ///< the angles of the skeleton, and of frames that do not say their own
};

/// One instant: where the root is and how every bone is turned.
struct MocapFrame {
  Eigen::Vector3d root_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d root_rad = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> turn_rad;  ///< by bone
};

/// Start and end of every bone, metres, y up.
struct MocapJoints {
  std::vector<Eigen::Vector3d> start_m;
  std::vector<Eigen::Vector3d> end_m;
};

/// Throw Error with the name, the line and the rule on a text that is none. Lengths are in units of an inch / `length`,
/// as CMU's files have it: metres = units * 0.0254 / length. Angles are in the skeleton's unit (deg or rad, degrees
/// where it says none) unless the frames begin with :DEGREES or :RADIANS. Names and values are quoted so that they
/// print.
[[nodiscard]] MocapSkeleton parse_asf(std::string_view text, const std::string& name);
[[nodiscard]] std::vector<MocapFrame> parse_amc(std::string_view text, const MocapSkeleton& skeleton,
                                                const std::string& name);

[[nodiscard]] MocapJoints joints(const MocapSkeleton& skeleton, const MocapFrame& frame);

}  // namespace depthgrid::simulation
