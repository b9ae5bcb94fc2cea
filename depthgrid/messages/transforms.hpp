// tf2_msgs/msg/TFMessage: where frames stand in other frames, on /tf and /tf_static.
#pragma once

#include <vector>

#include "depthgrid/messages/geometry.hpp"

namespace depthgrid::messages {

struct Transforms {
  std::vector<TransformStamped> transforms;
};

}  // namespace depthgrid::messages
