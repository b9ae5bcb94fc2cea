// A seven-joint arm for tests: the DH chain of the KUKA LWR4+ and limits that are usual for it.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "depthgrid/control/joint_limits.hpp"

namespace depthgrid::control::test {

inline constexpr int kLwrJoints = 7;

inline JointLimits lwr_limits() {
  constexpr double kDegree = std::numbers::pi / 180;
  JointLimits limits;
  limits.highest_rad.resize(kLwrJoints);
  limits.highest_rad << 170, 120, 170, 120, 170, 120, 170;
  limits.highest_rad *= kDegree;
  limits.lowest_rad = -limits.highest_rad;
  limits.velocity_rad_s.resize(kLwrJoints);
  limits.velocity_rad_s << 100, 110, 100, 130, 130, 180, 180;
  limits.velocity_rad_s *= kDegree;
  limits.acceleration_rad_s2 = JointVector::Constant(kLwrJoints, 300 * kDegree);
  return limits;
}

/// Bent, away from its singularities; the flange is in front of the base.
inline JointVector lwr_bent() {
  JointVector q(kLwrJoints);
  q << 0.1, 0.6, 0.0, -1.5, 0.0, 0.9, 0.0;
  return q;
}

/// Frames 0 (base) to 7 (flange) in the world, which is the base.
inline std::array<Eigen::Isometry3d, kLwrJoints + 1> lwr_frames(const JointVector& q) {
  constexpr std::array<double, kLwrJoints> kD{0.3105, 0, 0.400, 0, 0.390, 0, 0.078};
  constexpr std::array<double, kLwrJoints> kAlpha{1, -1, -1, 1, 1, -1, 0};
  std::array<Eigen::Isometry3d, kLwrJoints + 1> frames;
  frames[0].setIdentity();
  for (int i = 0; i < kLwrJoints; ++i) {
    const auto k = static_cast<std::size_t>(i);
    frames[k + 1] = frames[k] * Eigen::AngleAxisd(q[i], Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(0, 0, kD[k]) *
                    Eigen::AngleAxisd(kAlpha[k] * std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  }
  return frames;
}

/// A point of the arm and its Jacobian.
struct LwrPoint {
  Eigen::Vector3d p_world;
  PointJacobian jacobian;
};

/// `p_world`: a point that moves with frame `frame`.
inline LwrPoint lwr_point(const std::array<Eigen::Isometry3d, kLwrJoints + 1>& frames, std::size_t frame,
                          const Eigen::Vector3d& p_world) {
  LwrPoint point{p_world, PointJacobian::Zero(3, kLwrJoints)};
  for (std::size_t i = 0; i < frame; ++i) {
    const Eigen::Vector3d axis = frames[i].linear().col(2);
    point.jacobian.col(static_cast<Eigen::Index>(i)) = axis.cross(p_world - frames[i].translation());
  }
  return point;
}

inline LwrPoint lwr_flange(const JointVector& q) {
  const auto frames = lwr_frames(q);
  return lwr_point(frames, kLwrJoints, frames[kLwrJoints].translation());
}

/// Eight points along the body, beside the flange.
inline std::vector<LwrPoint> lwr_body(const JointVector& q) {
  const auto frames = lwr_frames(q);
  std::vector<LwrPoint> points;
  const auto between = [&](std::size_t frame, std::size_t from, std::size_t to, double share) {
    points.push_back(
        lwr_point(frames, frame, (1 - share) * frames[from].translation() + share * frames[to].translation()));
  };
  between(1, 0, 1, 0.5);
  between(2, 0, 1, 1.0);
  between(3, 2, 3, 0.5);
  between(4, 2, 3, 1.0);
  between(5, 4, 5, 0.33);
  between(5, 4, 5, 0.67);
  between(6, 4, 5, 1.0);
  between(7, 6, 7, 0.5);
  return points;
}

}  // namespace depthgrid::control::test
