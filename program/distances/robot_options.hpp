// The options of `distances` about a robot in the recording.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "program/robot_options.hpp"

namespace depthgrid::program {

/// As given. Without a URDF there is no robot.
struct RecordedRobotOptions {
  RobotFileOptions robot;
  std::string joints_file;
  std::vector<std::string> still_joints;       ///< NAME=VALUE, joints that the file lacks
  std::optional<std::string> joint_unit;       ///< radians or degrees
  std::optional<std::string> joint_time_unit;  ///< s, ms, us or ns
  std::optional<double> joint_time_offset_s;
  std::optional<double> joint_time_error_s;
  std::optional<double> joint_gap_s;
  std::optional<double> joint_speed;
  std::optional<std::string> base;
  std::optional<double> padding_m;
  bool least_padding = false;
  std::optional<double> robot_within_m;  ///< for least_padding

  [[nodiscard]] bool has_robot() const noexcept { return !robot.file.empty(); }
};

void add_recorded_robot_options(CLI::App& command, RecordedRobotOptions& options);

/// Throws UsageError when one of these options was given without --urdf, or --urdf without --joints and --base.
void check_robot_options(const RecordedRobotOptions& options);

/// T_world_base from "x,y,z", "x,y,z,roll,pitch,yaw" (radians, as in a URDF) or "x,y,z,qx,qy,qz,qw". Throws
/// UsageError, also where it is farther than check_plausible() takes.
[[nodiscard]] Pose base_pose(const std::string& text);

}  // namespace depthgrid::program
