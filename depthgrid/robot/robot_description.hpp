// What a robot file says: links with their shapes, and the joints between them. No kinematics yet, nothing checked.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "depthgrid/core/pose.hpp"

namespace depthgrid::robot {

/// Solids in their own frame, metres.
struct SphereShape {
  double radius_m = 0;
};
/// Centred, axis along z.
struct CylinderShape {
  double radius_m = 0;
  double length_m = 0;
};
/// A cylinder with round ends: centred, axis along z, the length without the ends.
struct CapsuleShape {
  double radius_m = 0;
  double length_m = 0;
};
/// Centred, sides along the axes.
struct BoxShape {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
};
/// A surface in a file; its coordinates times `scale` are metres.
struct MeshShape {
  std::filesystem::path file;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  std::string name{};  ///< as the robot's file has it, package://... for one
};

struct LinkShape {
  Pose T_link_shape = Pose::Identity();
  std::variant<SphereShape, CylinderShape, CapsuleShape, BoxShape, MeshShape> shape;
};

/// URDF has two for each link: coarse ones for collisions, and what the link looks like.
enum class ShapeKind : std::uint8_t { collision, visual };

struct LinkDescription {
  std::string name;
  std::vector<LinkShape> shapes;
  ShapeKind kind = ShapeKind::collision;  ///< of these shapes
};

enum class JointType {
  fixed,
  revolute,    ///< radians, between limits
  continuous,  ///< radians, without limits
  prismatic,   ///< metres, between limits
};

/// This joint's position is multiplier * (that joint's position) + offset.
struct Mimic {
  std::string joint;
  double multiplier = 1;
  double offset = 0;
};

/// The child's frame is the joint's frame, turned about or moved along `axis` by the joint's position.
struct JointDescription {
  std::string name;
  JointType type = JointType::fixed;
  std::string parent_link;
  std::string child_link;
  Pose T_parent_joint = Pose::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< in the joint's frame; any length but zero
  double lower = 0;                                 ///< rad or m; not used by fixed and continuous joints
  double upper = 0;
  double max_speed = 0;  ///< rad/s or m/s; not used by fixed joints
  std::optional<Mimic> mimic;
};

struct RobotDescription {
  std::string name;
  std::string source;  ///< where it comes from; begins every message about it
  std::vector<LinkDescription> links;
  std::vector<JointDescription> joints;
};

}  // namespace depthgrid::robot
