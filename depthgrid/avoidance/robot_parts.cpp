#include "depthgrid/avoidance/robot_parts.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/link_capsules.hpp"

namespace depthgrid::avoidance {

namespace {

RobotPart point_on(const robot::RobotModel& model, const char* link, double x, double y, double z) {
  const Eigen::Vector3d p(x, y, z);
  return {model.link_index(link), p, p, 0.0};
}

int joints_above(const robot::RobotModel& model, std::size_t link) {
  int joints = 0;
  for (std::optional<std::size_t> at = link; at; at = model.joint_of_link(*at).parent) {
    joints += model.joint_of_link(*at).joint ? 1 : 0;
  }
  return joints;
}

}  // namespace

std::vector<RobotPart> nine_control_points(const robot::RobotModel& model) {
  return {point_on(model, "lwr_7_link", 0, 0, 0),    point_on(model, "lwr_6_link", 0, 0, 0),
          point_on(model, "lwr_5_link", 0, 0, 0.10), point_on(model, "lwr_5_link", 0, 0, 0),
          point_on(model, "lwr_4_link", 0, 0, 0.10), point_on(model, "lwr_4_link", 0, 0, 0),
          point_on(model, "lwr_3_link", 0, 0, 0.10), point_on(model, "lwr_3_link", 0, 0, 0),
          point_on(model, "lwr_2_link", 0, 0, 0.10)};
}

std::vector<RobotPart> moving_capsules(const robot::RobotModel& model, int least_joints) {
  std::vector<RobotPart> parts;
  for (const robot::LinkCapsule& item : robot::link_capsules(model)) {
    if (joints_above(model, item.link) >= least_joints) {
      parts.push_back({item.link, item.capsule.a, item.capsule.b, item.capsule.radius_m});
    }
  }
  if (parts.empty()) {
    fail(model.source(), ": no link with a shape is moved by ", least_joints, " joints");
  }
  std::reverse(parts.begin(), parts.end());
  return parts;
}

void place(std::span<const RobotPart> parts, std::span<const Pose> T_world_link,
           std::span<search::Primitive> parts_world) noexcept {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Pose& T_world = T_world_link[parts[i].link];
    parts_world[i] = {T_world * parts[i].a_link, T_world * parts[i].b_link, parts[i].radius_m};
  }
}

}  // namespace depthgrid::avoidance
