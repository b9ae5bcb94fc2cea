// Where a camera was when: trajectories with time stamps, and a pose a file. Internal.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/pose.hpp"

namespace depthgrid::files {

/// The pose of a moving body at a time; metres, seconds.
struct StampedPose {
  double time_s = 0;
  Pose T_world_body = Pose::Identity();
};

/// Lines of "time_s tx ty tz qx qy qz qw", as in TUM's groundtruth.txt; # begins a comment. Throws Error that names
/// file, line, value and rule: no number, times that do not ascend, a quaternion whose length is off from 1 by more
/// than 1e-3, a translation beyond kLargestTranslation, another number of words, no pose at all.
std::vector<StampedPose> parse_trajectory(std::string_view text, const std::string& name);

/// The pose at a time: one of that very instant (kSameInstant_s), or one between two neighbours that are at most
/// `gap_s` apart, position linear and rotation along the shortest arc. Nothing is carried beyond the ends. Throws Error
/// that says what is missing, also where the neighbours differ by more than 90 degrees.
Pose pose_at(std::span<const StampedPose> trajectory, double time_s, std::optional<double> gap_s);

/// Sixteen numbers, rows of a 4 x 4 matrix, as in a pose file of 7-Scenes or ScanNet. Throws Error as
/// pose_from_matrix(); where entries are not finite the pose is missing, and the message says so.
Pose parse_pose_matrix(std::string_view text, const std::string& name);

}  // namespace depthgrid::files
