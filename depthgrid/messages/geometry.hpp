// geometry_msgs: metres, and rotations as quaternions.
#pragma once

#include "depthgrid/messages/standard.hpp"

namespace depthgrid::messages {

/// geometry_msgs/msg/Point.
struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// geometry_msgs/msg/Vector3.
struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// geometry_msgs/msg/Quaternion.
struct Quaternion {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;
};

/// geometry_msgs/msg/Pose.
struct PoseMessage {
  Point position;
  Quaternion orientation;
};

/// geometry_msgs/msg/Transform.
struct Transform {
  Vector3 translation;
  Quaternion rotation;
};

/// geometry_msgs/msg/TransformStamped: p_header.frame_id = transform * p_child_frame_id.
struct TransformStamped {
  Header header;
  std::string child_frame_id;
  Transform transform;
};

}  // namespace depthgrid::messages
