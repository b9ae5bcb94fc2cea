// The links of a robot in an order in which parents come first. Internal.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "depthgrid/robot/robot_description.hpp"

namespace depthgrid::robot {

/// One link and the joint that carries it. Indices are those of the description.
struct TreeLink {
  std::size_t link = 0;
  std::optional<std::size_t> joint;   ///< none: the root
  std::optional<std::size_t> parent;  ///< index in the tree, not in the description
};

/// All links, depth first from the root, children in the order of their joints' names. Throws Error, beginning with the
/// description's source, when names repeat, a joint names a link that is not there, a link hangs on two joints, or the
/// links do not form one tree.
[[nodiscard]] std::vector<TreeLink> link_tree(const RobotDescription& robot);

}  // namespace depthgrid::robot
