#include "program/distances/robot_options.hpp"

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "program/pose_option.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

constexpr const char* kGroup = "Robot";

void add_joint_options(CLI::App& command, RecordedRobotOptions& options) {
  command
      .add_option("--joints", options.joints_file,
                  "CSV file of joint positions: a header with time or frame, and the joints' names")
      ->group(kGroup);
  command
      .add_option("--joint", options.still_joints,
                  "NAME=VALUE: a joint that the file lacks stands there, radians or metres whatever --joint-unit says; "
                  "repeatable")
      ->allow_extra_args(false)
      ->group(kGroup);
  command
      .add_option("--joint-unit", options.joint_unit,
                  "unit of angles whose columns do not say it (default: radians, if they keep the joints' limits)")
      ->check(CLI::IsMember({"radians", "degrees"}))
      ->group(kGroup);
  command
      .add_option("--joint-time-unit", options.joint_time_unit,
                  "unit of a time column whose name does not say it (default: the only one that fits)")
      ->check(CLI::IsMember({"s", "ms", "us", "ns"}))
      ->group(kGroup);
  command
      .add_option("--joint-time-offset", options.joint_time_offset_s,
                  "added to the joints' times to get those of the images, seconds (default 0)")
      ->group(kGroup);
  command
      .add_option("--joint-time-error", options.joint_time_error_s,
                  "by how much an image's time may differ from the joints', seconds (default: half exposure and time "
                  "uncertainty of the cameras; 0 by frame number)")
      ->group(kGroup);
  command
      .add_option("--joint-gap", options.joint_gap_s,
                  "longest time between two rows to interpolate over, seconds (default 0.1)")
      ->group(kGroup);
  command
      .add_option("--joint-speed", options.joint_speed,
                  "greatest speed of joints for which the URDF states none, rad/s or m/s")
      ->group(kGroup);
}

}  // namespace

void add_recorded_robot_options(CLI::App& command, RecordedRobotOptions& options) {
  command
      .add_option("--urdf", options.robot.file,
                  "robot in the recording: it is taken out of the images, and with --method search and no control "
                  "point its links are asked for their distances")
      ->group(kGroup);
  add_joint_options(command, options);
  command
      .add_option("--base", options.base,
                  "where the robot's root stands in the rig's world: x,y,z or x,y,z,roll,pitch,yaw or "
                  "x,y,z,qx,qy,qz,qw; metres, radians (in its origin: 0,0,0)")
      ->group(kGroup);
  command
      .add_option("--robot-padding", options.padding_m,
                  "by how much the robot's capsules are thickened, metres (default 0): sensor, calibration and model; "
                  "what stands in this layer is not seen")
      ->group(kGroup);
  command
      .add_flag("--least-padding", options.least_padding,
                "instead of distances: the least --robot-padding at which each link is clear in these frames, which "
                "hold nobody, and the camera that decides it")
      ->group(kGroup);
  command
      .add_option("--robot-within", options.robot_within_m,
                  "for --least-padding: what is nearer to a link than this may be the robot, metres (default: from the "
                  "margins)")
      ->group(kGroup);
  add_robot_file_options(command, options.robot, kGroup);
}

void check_robot_options(const RecordedRobotOptions& options) {
  if (options.has_robot()) {
    if (options.least_padding && options.padding_m) {
      fail_usage("--least-padding finds the padding; leave out --robot-padding ", *options.padding_m);
    }
    if (options.robot_within_m && !options.least_padding) {
      fail_usage("--robot-within has no effect without --least-padding");
    }
    constexpr double kMostWithin_m = 1;
    if (options.robot_within_m && !(*options.robot_within_m >= 0 && *options.robot_within_m <= kMostWithin_m)) {
      fail_usage("--robot-within is ", *options.robot_within_m, " m, must be 0 to ", kMostWithin_m,
                 " m; is it in millimetres?");
    }
    if (options.joints_file.empty()) {
      fail_usage("--urdf needs --joints FILE.csv with the joint positions of the recording");
    }
    if (!options.base) {
      fail_usage(
          "--urdf needs --base, where the robot's root stands in the rig file's world (in its origin: --base 0,0,0)");
    }
    return;
  }
  const std::array<std::pair<bool, const char*>, 13> given{
      {{!options.joints_file.empty(), "--joints"},
       {!options.still_joints.empty(), "--joint"},
       {options.joint_unit.has_value(), "--joint-unit"},
       {options.joint_time_unit.has_value(), "--joint-time-unit"},
       {options.joint_time_offset_s.has_value(), "--joint-time-offset"},
       {options.joint_time_error_s.has_value(), "--joint-time-error"},
       {options.joint_gap_s.has_value(), "--joint-gap"},
       {options.joint_speed.has_value(), "--joint-speed"},
       {options.base.has_value(), "--base"},
       {options.padding_m.has_value(), "--robot-padding"},
       {options.least_padding, "--least-padding"},
       {options.robot_within_m.has_value(), "--robot-within"},
       {!options.robot.packages.empty(), "--package"}}};
  for (const auto& [is_given, name] : given) {
    if (is_given) {
      fail_usage(name, " has no effect without a robot; give --urdf FILE");
    }
  }
}

Pose base_pose(const std::string& text) {
  constexpr std::size_t kQuaternion = 7;
  constexpr std::size_t kAngles = 6;
  const std::vector<double> numbers = numbers_of("--base", text);
  if (numbers.size() != 3 && numbers.size() != kAngles && numbers.size() != kQuaternion) {
    fail_usage("--base ", text, ": ", numbers.size(),
               " numbers, must be 3 (x,y,z), 6 (and roll,pitch,yaw) or 7 (and qx,qy,qz,qw)");
  }
  Pose pose = Pose::Identity();
  if (numbers.size() == kQuaternion) {
    pose = pose_of_quaternion("--base", text, numbers);
  } else if (numbers.size() == kAngles) {
    for (std::size_t k = 3; k < kAngles; ++k) {
      if (std::abs(numbers[k]) > 2 * std::numbers::pi) {
        fail_usage("--base ", text, ": the angle ", numbers[k], " is beyond a turn; angles are radians");
      }
    }
    pose.linear() = (Eigen::AngleAxisd(numbers[5], Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(numbers[4], Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(numbers[3], Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  }
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  check_plausible_option("--base " + text, pose);
  return pose;
}

}  // namespace depthgrid::program
