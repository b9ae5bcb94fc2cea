#include "depthgrid/robot/urdf_joints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/urdf_elements.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

/// A joint as the file has it; one that leaves its link free has no type of a description.
struct UrdfJoint {
  JointDescription description;
  std::string_view free;  ///< "floating" or "planar"; empty for all others
};

void read_type(const pugi::xml_node& element, UrdfJoint& joint, const std::string& context) {
  constexpr std::array<std::pair<std::string_view, JointType>, 4> kTypes{{{"fixed", JointType::fixed},
                                                                          {"revolute", JointType::revolute},
                                                                          {"continuous", JointType::continuous},
                                                                          {"prismatic", JointType::prismatic}}};
  const std::string_view type = element.attribute("type").value();
  for (const auto& [name, value] : kTypes) {
    if (type == name) {
      joint.description.type = value;
      return;
    }
  }
  if (type != "floating" && type != "planar") {
    fail(context, "its type is '", shown(type), "', must be fixed, revolute, continuous or prismatic");
  }
  joint.free = type;
}

/// Limits in degrees and millimetres. Greater numbers are a way of saying that there is none.
void check_unit(const JointDescription& joint, const char* what, double limit, const std::string& context) {
  constexpr double kMaxTurn = 30;       // radians, nearly five turns to either side
  constexpr double kMaxDegrees = 1080;  // three turns
  constexpr double kMaxMillimetres = 1e4;
  const bool turns = joint.type == JointType::revolute;
  const double size = std::abs(limit);
  if (turns && size > kMaxTurn && size <= kMaxDegrees) {
    fail(context, "its limit ", what, " is ", limit, " rad, must be within ", kMaxTurn,
         " rad; angles in a URDF are radians: in degrees? did you mean ", limit * (std::numbers::pi / 180), "?");
  }
  if (!turns && size > kMaxLength_m && size <= kMaxMillimetres) {
    fail(context, "its limit ", what, " is ", limit, " m, must be within ", kMaxLength_m,
         " m; lengths in a URDF are metres: in millimetres? did you mean ", 1e-3 * limit, "?");
  }
}

void read_limit(const pugi::xml_node& element, JointDescription& joint, const std::string& context) {
  const pugi::xml_node limit = only_child(element, "limit", context);
  refuse_misspelt(limit, {"lower", "upper", "velocity", "effort"}, context);
  const double speed = number_of(limit, "velocity", context).value_or(0);
  if (speed < 0) {
    fail(context, "its greatest speed is ", speed, ", must be positive, or 0 where it is not stated");
  }
  joint.max_speed = speed > 0 ? speed : std::numeric_limits<double>::infinity();
  if (joint.type == JointType::continuous) {
    return;
  }
  if (!limit) {
    fail(context, "it has no <limit>, must have one with lower and upper");
  }
  joint.lower = number_of(limit, "lower", context).value_or(0);
  joint.upper = number_of(limit, "upper", context).value_or(0);
  check_unit(joint, "lower", joint.lower, context);
  check_unit(joint, "upper", joint.upper, context);
}

void read_mimic(const pugi::xml_node& element, JointDescription& joint, const std::string& context) {
  const pugi::xml_node mimic = only_child(element, "mimic", context);
  if (!mimic) {
    return;
  }
  refuse_misspelt(mimic, {"joint", "multiplier", "offset"}, context);
  joint.mimic =
      Mimic{name_of(mimic.attribute("joint"), "the joint that it mimics", context),
            number_of(mimic, "multiplier", context).value_or(1), number_of(mimic, "offset", context).value_or(0)};
}

UrdfJoint joint_of(const pugi::xml_node& element, const std::string& source) {
  UrdfJoint result;
  JointDescription& joint = result.description;
  joint.name = name_of(element.attribute("name"), "a joint", source + ": ");
  const std::string context = source + ": joint '" + joint.name + "': ";
  refuse_misspelt(element, {"name", "type", "origin", "parent", "child", "axis", "limit", "mimic"}, context);
  read_type(element, result, context);
  joint.parent_link = name_of(only_child(element, "parent", context).attribute("link"), "its parent", context);
  joint.child_link = name_of(only_child(element, "child", context).attribute("link"), "its child", context);
  joint.T_parent_joint = origin_of(element, context);
  joint.lower = -std::numeric_limits<double>::infinity();
  joint.upper = joint.max_speed = std::numeric_limits<double>::infinity();
  if (joint.type != JointType::fixed) {
    joint.axis = vector_of(only_child(element, "axis", context), "xyz", context).value_or(Eigen::Vector3d::UnitX());
    read_limit(element, joint, context);
    read_mimic(element, joint, context);
  }
  return result;
}

void resolve_mimics(RobotDescription& robot) {
  std::map<std::string, Mimic> mimics;
  for (const JointDescription& joint : robot.joints) {
    if (joint.mimic) {
      mimics.emplace(joint.name, *joint.mimic);
    }
  }
  for (JointDescription& joint : robot.joints) {
    std::size_t steps = 0;
    for (auto next = mimics.end(); joint.mimic && (next = mimics.find(joint.mimic->joint)) != mimics.end(); ++steps) {
      if (steps > mimics.size()) {
        fail(robot.source, ": joint '", joint.name, "': it mimics '", mimics.at(joint.name).joint,
             "', which mimics others in a circle");
      }
      joint.mimic->joint = next->second.joint;
      joint.mimic->offset += joint.mimic->multiplier * next->second.offset;
      joint.mimic->multiplier *= next->second.multiplier;
    }
  }
}

/// The links above a free joint, where there is nothing else above and beside it.
std::set<std::string> empty_links_above(const UrdfJoint& free, const std::vector<UrdfJoint>& joints,
                                        const RobotDescription& robot) {
  std::map<std::string, std::vector<const UrdfJoint*>> below;
  std::map<std::string, const UrdfJoint*> above;
  for (const UrdfJoint& joint : joints) {
    below[joint.description.parent_link].push_back(&joint);
    above.emplace(joint.description.child_link, &joint);
  }
  std::set<std::string> result;
  for (std::string link = free.description.parent_link;;) {
    const auto found = std::find_if(robot.links.begin(), robot.links.end(),
                                    [&link](const LinkDescription& item) { return item.name == link; });
    const bool empty = found != robot.links.end() && found->shapes.empty() && below[link].size() == 1;
    const auto carrier = above.find(link);
    const bool still = carrier == above.end() || carrier->second->description.type == JointType::fixed;
    if (!empty || !still || !result.insert(link).second) {
      fail(robot.source, ": joint '", free.description.name, "': its type is ", free.free,
           ", must be fixed, revolute, continuous or prismatic; only at a root without shapes and other children may "
           "it be, whose child then is the root");
    }
    if (carrier == above.end()) {
      return result;
    }
    link = carrier->second->description.parent_link;
  }
}

}  // namespace

void add_joints(const pugi::xml_node& element, RobotDescription& robot) {
  std::vector<UrdfJoint> joints;
  for (const pugi::xml_node& joint : element.children("joint")) {
    joints.push_back(joint_of(joint, robot.source));
  }
  std::set<std::string> left_out;
  for (const UrdfJoint& joint : joints) {
    if (!joint.free.empty() && !left_out.contains(joint.description.parent_link)) {
      left_out.merge(empty_links_above(joint, joints, robot));
    }
  }
  for (UrdfJoint& joint : joints) {
    if (!left_out.contains(joint.description.parent_link)) {
      robot.joints.push_back(std::move(joint.description));
    }
  }
  std::erase_if(robot.links, [&left_out](const LinkDescription& link) { return left_out.contains(link.name); });
  resolve_mimics(robot);
}

}  // namespace depthgrid::robot
