#include "lab/experiments/stage/arm_at_work.hpp"

#include <cmath>

#include "depthgrid/robot/kuka_lwr4.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kFirstPoint = 0.43;   ///< length along the axis from the base, metres: 12 cm above the shoulder
constexpr double kLastPoint = 1.1785;  ///< the flange

/// On the link in whose part of the axis each lies; with all angles 0 the axis is the world's z.
std::vector<robot::ControlPoint> points_on_axis(const robot::RobotModel& model) {
  std::vector<Pose> T_world_link(model.links().size());
  (void)model.link_poses(std::vector<double>(model.joints().size(), 0.0), Pose::Identity(), T_world_link);
  std::vector<robot::ControlPoint> points;
  for (std::size_t i = 0; i < kControlPoints; ++i) {
    const double height_m = kFirstPoint + (kLastPoint - kFirstPoint) * static_cast<double>(i) / (kControlPoints - 1);
    robot::ControlPoint point;
    for (std::size_t link = 0; link < T_world_link.size(); ++link) {
      if (T_world_link[link].translation().z() <= height_m + 1e-9) {
        point.link = link;
      }
    }
    point.p_link = T_world_link[point.link].inverse(Eigen::Isometry) * Eigen::Vector3d(0, 0, height_m);
    points.push_back(point);
  }
  return points;
}

}  // namespace

ArmAtWork::ArmAtWork()
    : model_(robot::kuka_lwr4()),
      capsules_(robot::link_capsules(model_)),
      points_(points_on_axis(model_)),
      T_world_link_(model_.links().size()),
      capsules_world_(capsules_.size()),
      points_world_(points_.size()) {
  move_to(0);
}

void ArmAtWork::move_to(double time_s) {
  const double a = std::sin(0.7 * time_s);
  const double b = std::sin(1.1 * time_s);
  pose({-1.4 + 0.6 * a, -0.5 + 0.3 * b, 0, 1.2 + 0.4 * a, 0, -0.6, 0});
}

void ArmAtWork::pose(const std::array<double, 7>& q_rad) {
  (void)model_.link_poses(q_rad, Pose::Identity(), T_world_link_);
  robot::place(capsules_, T_world_link_, capsules_world_);
  robot::place(points_, T_world_link_, points_world_);
}

}  // namespace depthgrid::experiments
