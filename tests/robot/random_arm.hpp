// A random arm: as the library's model, and as this test's own product of matrices.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "depthgrid/robot/placed_robot.hpp"
#include "robot/robot_support.hpp"

namespace depthgrid::robot {

/// A chain of links: every joint in its own direction, some slide, some do not move, one may mimic another.
class RandomArm {
 public:
  explicit RandomArm(Random& random) {
    const int joints = random.integer(4, 8);
    for (int i = 0; i < joints; ++i) {
      Link link;
      link.T_parent_joint = random.pose(0.4).matrix();
      link.axis = random.unit();
      // The first two always turn: with less there is no arm.
      const int kind = i < 2 ? 0 : random.integer(0, 5);
      link.slides = kind == 4;
      link.stands = kind == 5;
      if (i > 2 && kind == 3) {
        link.mimics = 0;
        link.multiplier = random.uniform(-2, 2);
        link.offset = random.uniform(-1, 1);
      }
      links_.push_back(link);
    }
    T_world_base_ = random.pose(1);
  }

  [[nodiscard]] PlacedRobot placed() const {
    RobotDescription description{.name = "arm", .source = "random arm", .links = {}, .joints = {}};
    description.links.push_back({.name = "l0", .shapes = {}, .kind = ShapeKind::collision});
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& link = links_[i];
      JointDescription joint;
      joint.name = "j" + std::to_string(i);
      joint.type = link.stands ? JointType::fixed : link.slides ? JointType::prismatic : JointType::revolute;
      joint.parent_link = "l" + std::to_string(i);
      joint.child_link = "l" + std::to_string(i + 1);
      joint.T_parent_joint = Pose(link.T_parent_joint);
      joint.axis = 3 * link.axis;
      joint.lower = -3;
      joint.upper = 3;
      joint.max_speed = 1;
      if (link.mimics >= 0) {
        joint.mimic = Mimic{"j" + std::to_string(link.mimics), link.multiplier, link.offset};
      }
      description.links.push_back({.name = joint.child_link, .shapes = {}, .kind = ShapeKind::collision});
      description.joints.push_back(joint);
    }
    return {RobotModel(description), T_world_base_};
  }

  /// How many joints have a position of their own.
  [[nodiscard]] int joints() const {
    int count = 0;
    for (const Link& link : links_) {
      count += link.stands || link.mimics >= 0 ? 0 : 1;
    }
    return count;
  }
  [[nodiscard]] bool mimics() const {
    return std::any_of(links_.begin(), links_.end(), [](const Link& link) { return link.mimics >= 0; });
  }
  [[nodiscard]] int links() const { return static_cast<int>(links_.size()) + 1; }

  /// Where a point of a link is.
  [[nodiscard]] Eigen::Vector3d at(const Eigen::VectorXd& q, int link, const Eigen::Vector3d& p_link) const {
    std::vector<double> position;
    int next = 0;
    for (const Link& one : links_) {
      position.push_back(one.stands ? 0.0
                         : one.mimics >= 0
                             ? one.multiplier * position[static_cast<std::size_t>(one.mimics)] + one.offset
                             : q[next++]);
    }
    Eigen::Vector4d p = p_link.homogeneous();
    for (int i = link - 1; i >= 0; --i) {
      const auto k = static_cast<std::size_t>(i);
      p = links_[k].T_parent_joint * (links_[k].moved(position[k]) * p);
    }
    return (T_world_base_.matrix() * p).head<3>();
  }

  /// How fast it goes: a column a joint, by differences.
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& q, int link, const Eigen::Vector3d& p_link) const {
    constexpr double kStep = 1e-5;
    Eigen::MatrixXd result(3, q.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      Eigen::VectorXd low = q;
      Eigen::VectorXd high = q;
      low[j] -= kStep;
      high[j] += kStep;
      result.col(j) = (at(high, link, p_link) - at(low, link, p_link)) / (2 * kStep);
    }
    return result;
  }

  /// The same place in the frame of its link: where that is what the matrices say.
  [[nodiscard]] Eigen::Vector3d in_link(const Eigen::VectorXd& q, int link, const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d origin = at(q, link, Eigen::Vector3d::Zero());
    Eigen::Matrix3d axes;
    for (int i = 0; i < 3; ++i) {
      axes.col(i) = at(q, link, Eigen::Vector3d::Unit(i)) - origin;
    }
    return axes.transpose() * (p_world - origin);
  }

 private:
  struct Link {
    Eigen::Matrix4d T_parent_joint;
    Eigen::Vector3d axis;
    bool slides = false;
    bool stands = false;
    int mimics = -1;
    double multiplier = 1;
    double offset = 0;

    [[nodiscard]] Eigen::Matrix4d moved(double position) const {
      Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
      if (slides) {
        T.topRightCorner<3, 1>() = position * axis;
      } else if (!stands) {
        // Rodrigues' formula.
        Eigen::Matrix3d cross;
        cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
        T.topLeftCorner<3, 3>() += std::sin(position) * cross + (1 - std::cos(position)) * cross * cross;
      }
      return T;
    }
  };

  std::vector<Link> links_;
  Pose T_world_base_;
};

}  // namespace depthgrid::robot
