// What the tests of the robot share: random numbers, joint positions and cameras.
#pragma once

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::robot {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  Eigen::Vector3d in_cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Eigen::Vector3d unit() {
    for (;;) {
      const Eigen::Vector3d v = in_cube(1);
      if (v.norm() > 0.1 && v.norm() < 1) {
        return v.normalized();
      }
    }
  }
  Pose pose(double half) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(uniform(-3, 3), unit()).toRotationMatrix();
    pose.translation() = in_cube(half);
    return pose;
  }
  std::vector<double> positions(const RobotModel& model) {
    std::vector<double> q;
    for (const Joint& joint : model.joints()) {
      const bool limited = joint.type != JointType::continuous;
      q.push_back(uniform(limited ? joint.lower : -7.0, limited ? joint.upper : 7.0));
    }
    return q;
  }

 private:
  std::mt19937_64 engine_;
};

inline std::vector<Pose> link_poses(const RobotModel& model, const std::vector<double>& q,
                                    const Pose& T_world_base = Pose::Identity()) {
  std::vector<Pose> poses(model.links().size());
  if (!model.link_poses(q, T_world_base, poses)) {
    std::abort();
  }
  return poses;
}

/// A Kinect-like camera at a distance from the arm's shoulder, which stands at the origin.
inline Pose random_camera_pose(Random& random, double least_m, double most_m) {
  for (;;) {
    const Eigen::Vector3d direction = random.unit();
    if (std::abs(direction.z()) < 0.9) {
      const Eigen::Vector3d target = Eigen::Vector3d(0, 0, 0.4) + random.in_cube(0.3);
      return look_at(target + random.uniform(least_m, most_m) * direction, target);
    }
  }
}

inline std::filesystem::path robot_data() {
  const char* given = std::getenv("DEPTHGRID_DATA");
  return std::filesystem::path(given != nullptr ? given : "../shared/data") / "robots";
}

}  // namespace depthgrid::robot

/// Skips the test where the robots of the data folder are not there, and says so.
#define DEPTHGRID_REQUIRE_ROBOT_DATA()                                          \
  if (!std::filesystem::is_directory(depthgrid::robot::robot_data())) {         \
    GTEST_SKIP() << "no robots in '" << depthgrid::robot::robot_data().string() \
                 << "': set DEPTHGRID_DATA to the folder that holds 'robots'";  \
  }                                                                             \
  static_assert(true)
