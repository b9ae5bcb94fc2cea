#include "depthgrid/robot/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/link_tree.hpp"

namespace depthgrid::robot {

namespace {

bool moves(const JointDescription& joint) { return joint.type != JointType::fixed; }

/// A link's joint: turns about z of a fixed frame, or slides along it.
struct JointMotion {
  JointType type = JointType::fixed;
  Pose T_parent_axis = Pose::Identity();
  Eigen::Matrix3d R_axis_link = Eigen::Matrix3d::Identity();  ///< at position 0

  [[nodiscard]] Pose pose(double position) const {
    Pose T_parent_link = T_parent_axis;
    Eigen::Matrix3d turned = R_axis_link;
    if (type == JointType::prismatic) {
      T_parent_link.translation() += position * T_parent_axis.linear().col(2);
    } else if (type != JointType::fixed) {
      const double c = std::cos(position);
      const double s = std::sin(position);
      turned.row(0) = c * R_axis_link.row(0) - s * R_axis_link.row(1);
      turned.row(1) = s * R_axis_link.row(0) + c * R_axis_link.row(1);
    }
    T_parent_link.linear() = T_parent_axis.linear() * turned;
    return T_parent_link;
  }
};

JointMotion motion_of(const JointDescription& joint) {
  if (!moves(joint)) {
    return {joint.type, joint.T_parent_joint};
  }
  Pose T_joint_axis = Pose::Identity();
  T_joint_axis.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), joint.axis).toRotationMatrix();
  return {joint.type, joint.T_parent_joint * T_joint_axis, T_joint_axis.linear().transpose()};
}

void check(const JointDescription& joint, const std::string& source) {
  const std::string context = source + ": joint '" + joint.name + "': ";
  if (!joint.T_parent_joint.matrix().allFinite()) {
    fail(context, "its origin is not finite");
  }
  if (!moves(joint)) {
    return;
  }
  if (!joint.axis.allFinite() || !(joint.axis.norm() > 1e-9)) {
    fail(context, "its axis is (", joint.axis.transpose(), "), must be finite and not zero");
  }
  if (!(joint.max_speed > 0)) {
    fail(context, "its greatest speed is ", joint.max_speed, ", must be positive");
  }
  if (joint.type != JointType::continuous) {
    if (!(std::isfinite(joint.lower) && std::isfinite(joint.upper) && joint.lower <= joint.upper)) {
      fail(context, "its limits are ", joint.lower, " and ", joint.upper, ", must be finite and in this order");
    }
  }
  if (joint.mimic && !(std::isfinite(joint.mimic->multiplier) && std::isfinite(joint.mimic->offset))) {
    fail(context, "it mimics with multiplier ", joint.mimic->multiplier, " and offset ", joint.mimic->offset,
         ", must be finite");
  }
}

Joint joint_of(const JointDescription& description) {
  Joint joint;
  joint.name = description.name;
  joint.type = description.type;
  const bool limited = description.type != JointType::continuous;
  joint.lower = limited ? description.lower : -std::numeric_limits<double>::infinity();
  joint.upper = limited ? description.upper : std::numeric_limits<double>::infinity();
  joint.max_speed = description.max_speed;
  return joint;
}

}  // namespace

struct RobotModel::Parts {
  std::string name;
  std::string source;
  std::vector<LinkDescription> links;
  std::vector<Joint> joints;
  std::vector<LinkJoint> carriers;   ///< of each link
  std::vector<JointMotion> motions;  ///< of each link; the root does not move

  explicit Parts(RobotDescription&& robot);

 private:
  void add_link(std::size_t parent, const JointDescription& joint);
  void follow(LinkJoint& carrier, const JointDescription& joint) const;
};

void RobotModel::Parts::add_link(std::size_t parent, const JointDescription& joint) {
  check(joint, source);
  LinkJoint carrier;
  carrier.parent = parent;
  carrier.type = joint.type;
  if (moves(joint)) {
    carrier.axis_link = joint.axis.normalized();
    if (!joint.mimic) {
      carrier.joint = joints.size();
      joints.push_back(joint_of(joint));
    }
  }
  carriers.push_back(carrier);
  motions.push_back(motion_of(joint));
}

/// Makes the carrier of a link follow the joint that `joint` mimics.
void RobotModel::Parts::follow(LinkJoint& carrier, const JointDescription& joint) const {
  const auto master = std::find_if(joints.begin(), joints.end(),
                                   [&joint](const Joint& other) { return other.name == joint.mimic->joint; });
  if (master == joints.end()) {
    fail(source, ": joint '", joint.name, "': it mimics '", joint.mimic->joint,
         "', which is not there, does not move or mimics another itself");
  }
  carrier.joint = static_cast<std::size_t>(master - joints.begin());
  carrier.multiplier = joint.mimic->multiplier;
  carrier.offset = joint.mimic->offset;
}

RobotModel::Parts::Parts(RobotDescription&& robot) : name(std::move(robot.name)), source(robot.source) {
  const std::vector<TreeLink> tree = link_tree(robot);
  for (const TreeLink& item : tree) {
    links.push_back(std::move(robot.links[item.link]));
    if (item.joint && item.parent) {
      add_link(*item.parent, robot.joints[*item.joint]);
    } else {
      carriers.emplace_back();
      motions.emplace_back();
    }
  }
  for (std::size_t i = 0; i < tree.size(); ++i) {  // when all joints have their numbers
    if (const auto joint = tree[i].joint; joint && moves(robot.joints[*joint]) && robot.joints[*joint].mimic) {
      follow(carriers[i], robot.joints[*joint]);
    }
  }
}

RobotModel::RobotModel(RobotDescription description) : parts_(std::make_shared<const Parts>(std::move(description))) {}

const std::string& RobotModel::name() const noexcept { return parts_->name; }
const std::string& RobotModel::source() const noexcept { return parts_->source; }
const std::vector<Joint>& RobotModel::joints() const noexcept { return parts_->joints; }
const std::vector<LinkDescription>& RobotModel::links() const noexcept { return parts_->links; }
const LinkJoint& RobotModel::joint_of_link(std::size_t link) const noexcept { return parts_->carriers[link]; }

std::size_t RobotModel::link_index(std::string_view link) const {
  for (std::size_t i = 0; i < parts_->links.size(); ++i) {
    if (parts_->links[i].name == link) {
      return i;
    }
  }
  fail(parts_->source, ": there is no link '", link, "'");
}

bool RobotModel::link_poses(std::span<const double> q, const Pose& T_world_base,
                            std::span<Pose> T_world_link) const noexcept {
  if (q.size() != parts_->joints.size() || T_world_link.size() != parts_->links.size()) {
    return false;
  }
  for (std::size_t i = 0; i < T_world_link.size(); ++i) {
    const LinkJoint& carrier = parts_->carriers[i];
    const Pose& T_world_parent = carrier.parent ? T_world_link[*carrier.parent] : T_world_base;
    const double position = carrier.joint ? carrier.multiplier * q[*carrier.joint] + carrier.offset : 0.0;
    T_world_link[i] = T_world_parent * parts_->motions[i].pose(position);
  }
  return true;
}

bool RobotModel::jacobian(std::span<const double> q, std::span<const Pose> T_world_link, std::size_t link,
                          const Eigen::Vector3d& p_world, Eigen::Ref<Jacobian> jacobian) const noexcept {
  if (q.size() != parts_->joints.size() || T_world_link.size() != parts_->links.size() || link >= T_world_link.size() ||
      jacobian.cols() != static_cast<Eigen::Index>(q.size())) {
    return false;
  }
  jacobian.setZero();
  for (std::optional<std::size_t> i = link; i && parts_->carriers[*i].parent; i = parts_->carriers[*i].parent) {
    const LinkJoint& carrier = parts_->carriers[*i];
    if (!carrier.joint) {
      continue;
    }
    // At unit speed of the joint.
    const Eigen::Matrix3d& R_parent_axis = parts_->motions[*i].T_parent_axis.linear();
    const Eigen::Vector3d axis_world =
        T_world_link[*carrier.parent].linear() * (carrier.multiplier * R_parent_axis.col(2));
    auto column = jacobian.col(static_cast<Eigen::Index>(*carrier.joint));
    if (carrier.type == JointType::prismatic) {
      column.head<3>() += axis_world;
    } else {
      column.head<3>() += axis_world.cross(p_world - T_world_link[*i].translation());
      column.tail<3>() += axis_world;
    }
  }
  return true;
}

}  // namespace depthgrid::robot
