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

std::vector<LinkCapsule> moving_capsules(const RobotModel& model, int least_joints, const CapsuleOptions& options) {
  std::vector<LinkCapsule> parts;
  for (const LinkCapsule& item : link_capsules(model, options)) {
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

std::vector<LinkCapsule> tip_first(std::vector<LinkCapsule> parts, std::size_t tip_link) {
  const auto tip = std::find_if(parts.begin(), parts.end(), [=](const auto& part) { return part.link == tip_link; });
  if (tip == parts.end()) {
    parts.insert(parts.begin(), {tip_link, {}});
  } else {
    std::rotate(parts.begin(), tip, tip + 1);
  }
  return parts;
}

}  // namespace depthgrid::robot
