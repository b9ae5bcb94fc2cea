// The joints of a URDF file. Internal.
#pragma once

#include <pugixml.hpp>

#include "depthgrid/robot/robot_description.hpp"

namespace depthgrid::robot {

/// Adds the <joint>s of a <robot> whose links `robot` has already. Joints that mimic one that mimics another itself
/// follow the last of them. A floating or planar joint below nothing but a chain of links without shapes is left out
/// together with these links: its child is the root, whose place is T_world_base. Throws Error, beginning with
/// `robot.source`, on joints of other types, mimics in a circle, and numbers that break a rule.
void add_joints(const pugi::xml_node& element, RobotDescription& robot);

}  // namespace depthgrid::robot
