#include "depthgrid/robot/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <kdl/segment.hpp>
#include <limits>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/link_tree.hpp"

namespace depthgrid::robot {

namespace {

KDL::Vector kdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

KDL::Frame kdl(const Pose& pose) {
  const Eigen::Matrix3d& r = pose.linear();
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
          kdl(Eigen::Vector3d(pose.translation()))};
}

Pose eigen(const KDL::Frame& frame) {
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    pose.translation()[row] = frame.p(row);
    for (int column = 0; column < 3; ++column) {
      pose.linear()(row, column) = frame.M(row, column);
    }
  }
  return pose;
}

bool moves(const JointDescription& joint) { return joint.type != JointType::fixed; }

/// A link's joint in two steps: a fixed frame whose z axis is the joint's, and KDL's segment from there to the link.
/// KDL keeps the last angle of joints about other axes in the joint itself, which threads would then share.
struct JointSegment {
  KDL::Frame T_parent_axis;
  KDL::Segment T_axis_link;  ///< at a joint position

  KDL::Frame pose(double position) const { return T_parent_axis * T_axis_link.pose(position); }
  /// Of the link's origin, in the parent's frame.
  KDL::Twist twist(double position, double speed) const { return T_parent_axis.M * T_axis_link.twist(position, speed); }
};

JointSegment segment_of(const std::string& link, const JointDescription& joint) {
  if (!moves(joint)) {
    return {kdl(joint.T_parent_joint), KDL::Segment(link, KDL::Joint(joint.name, KDL::Joint::None))};
  }
  Pose T_joint_axis = Pose::Identity();
  T_joint_axis.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), joint.axis).toRotationMatrix();
  const auto type = joint.type == JointType::prismatic ? KDL::Joint::TransZ : KDL::Joint::RotZ;
  return {kdl(joint.T_parent_joint * T_joint_axis),
          KDL::Segment(link, KDL::Joint(joint.name, type), kdl(T_joint_axis.inverse()))};
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
  std::vector<LinkJoint> carriers;     ///< of each link
  std::vector<JointSegment> segments;  ///< of each link; the root's is a fixed one

  explicit Parts(RobotDescription&& robot);

 private:
  void add_root(const std::string& link);
  void add_link(const std::string& link, std::size_t parent, const JointDescription& joint);
  void follow(LinkJoint& carrier, const JointDescription& joint) const;
};

void RobotModel::Parts::add_root(const std::string& link) {
  carriers.emplace_back();
  segments.push_back({KDL::Frame::Identity(), KDL::Segment(link)});
}

void RobotModel::Parts::add_link(const std::string& link, std::size_t parent, const JointDescription& joint) {
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
  segments.push_back(segment_of(link, joint));
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
      add_link(links.back().name, *item.parent, robot.joints[*item.joint]);
    } else {
      add_root(links.back().name);
    }
  }
  for (std::size_t i = 0; i < tree.size(); ++i) {  // when all joints have their numbers
    if (const auto joint = tree[i].joint; joint && moves(robot.joints[*joint]) && robot.joints[*joint].mimic) {
      follow(carriers[i], robot.joints[*joint]);
    }
  }
}

RobotModel::RobotModel(RobotDescription description) : parts_(std::make_unique<const Parts>(std::move(description))) {}
RobotModel::~RobotModel() = default;
RobotModel::RobotModel(RobotModel&&) noexcept = default;
RobotModel& RobotModel::operator=(RobotModel&&) noexcept = default;

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
    T_world_link[i] = T_world_parent * eigen(parts_->segments[i].pose(position));
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
    // Velocity of the segment's tip at unit joint speed, in the parent's frame; then of p, in the world's.
    const double position = carrier.multiplier * q[*carrier.joint] + carrier.offset;
    const KDL::Twist tip =
        kdl(T_world_link[*carrier.parent]).M * parts_->segments[*i].twist(position, carrier.multiplier);
    const KDL::Twist twist = tip.RefPoint(kdl(Eigen::Vector3d(p_world - T_world_link[*i].translation())));
    for (int row = 0; row < 6; ++row) {
      jacobian(row, static_cast<Eigen::Index>(*carrier.joint)) += twist(row);
    }
  }
  return true;
}

}  // namespace depthgrid::robot
