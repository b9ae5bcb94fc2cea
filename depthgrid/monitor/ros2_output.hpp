// Answers of a running cell as topics of ROS 2.
#pragma once

#include <memory>
#include <string>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/dds/node.hpp"
#include "depthgrid/monitor/monitor.hpp"

namespace depthgrid::monitor {

struct Ros2OutputSettings {
  Names names;
  Rig rig;                        ///< whose cameras' frames are told
  std::string frame = "world";    ///< what the world frame is called
  std::string robot_description;  ///< the URDF's text; empty: not told
};

/// Publishes, in the node's namespace, which needs not outlive it otherwise:
/// - `distances`, depthgrid_msgs/Distances: every answer that there is time for;
/// - `markers`, visualization_msgs/MarkerArray: twenty a second, the parts, a line from each to its nearest point,
/// coloured
///   by what is there, and the sentence that says why the answer is what it is;
/// - /diagnostics, diagnostic_msgs/DiagnosticArray: once a second, the cell and each camera;
/// - /tf_static and /robot_description, once, for whoever comes.
///
/// Throws Error as dds::Node does.
[[nodiscard]] std::unique_ptr<Output> ros2_output(std::shared_ptr<dds::Node> node, const Ros2OutputSettings& settings);

}  // namespace depthgrid::monitor
