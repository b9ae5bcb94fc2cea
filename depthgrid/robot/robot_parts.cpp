#include "depthgrid/robot/robot_parts.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

namespace {

LinkCapsule point_on(const RobotModel& model, const char* link, double x, double y, double z) {
  return {model.link_index(link), Capsule::point({x, y, z})};
}

int joints_above(const RobotModel& model, std::size_t link) {
  int joints = 0;
  for (std::optional<std::size_t> at = link; at; at = model.joint_of_link(*at).parent) {
    joints += model.joint_of_link(*at).joint ? 1 : 0;
  }
  return joints;
}

}  // namespace

std::vector<LinkCapsule> nine_control_points(const RobotModel& model) {
  return {point_on(model, "lwr_7_link", 0, 0, 0),    point_on(model, "lwr_6_link", 0, 0, 0),
          point_on(model, "lwr_5_link", 0, 0, 0.10), point_on(model, "lwr_5_link", 0, 0, 0),
          point_on(model, "lwr_4_link", 0, 0, 0.10), point_on(model, "lwr_4_link", 0, 0, 0),
          point_on(model, "lwr_3_link", 0, 0, 0.10), point_on(model, "lwr_3_link", 0, 0, 0),
          point_on(model, "lwr_2_link", 0, 0, 0.10)};
}

std::vector<LinkCapsule> moving_capsules(const RobotModel& model, int least_joints) {
  std::vector<LinkCapsule> parts;
  for (const LinkCapsule& item : link_capsules(model)) {
    if (joints_above(model, item.link) >= least_joints) {
      parts.push_back(item);
    }
  }
  if (parts.empty()) {
    fail(model.source(), ": no link with a shape is moved by ", least_joints, " joints");
  }
  std::reverse(parts.begin(), parts.end());
  return parts;
}

}  // namespace depthgrid::robot
