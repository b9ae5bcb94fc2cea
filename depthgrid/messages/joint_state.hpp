// sensor_msgs/msg/JointState: positions (radians, metres), velocities and efforts by the joints' names.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/messages/standard.hpp"

namespace depthgrid::messages {

/// Each of the three lists is empty or as long as `name`; whoever reads a message has to see to that.
struct JointState {
  Header header;
  std::vector<std::string> name;
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> effort;
};

}  // namespace depthgrid::messages
