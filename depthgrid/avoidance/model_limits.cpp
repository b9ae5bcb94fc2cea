#include "depthgrid/avoidance/model_limits.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::avoidance {

control::JointLimits joint_limits(const robot::RobotModel& model, double acceleration_rad_s2) {
  constexpr double kNoEnd_rad = 1000;
  const std::size_t joints = model.joints().size();
  if (joints < 1 || joints > control::kMaxJoints) {
    fail(model.source(), ": ", joints, " joints, the controller takes 1 to ", control::kMaxJoints,
         "; make those that it shall not move fixed in the file");
  }
  const auto count = static_cast<Eigen::Index>(joints);
  control::JointLimits limits;
  limits.lowest_rad.resize(count);
  limits.highest_rad.resize(count);
  limits.velocity_rad_s.resize(count);
  limits.acceleration_rad_s2.setConstant(count, acceleration_rad_s2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const robot::Joint& joint = model.joints()[static_cast<std::size_t>(i)];
    if (!(joint.lower < joint.upper)) {
      fail(model.source(), ": joint '", joint.name, "' reaches from ", joint.lower, " to ", joint.upper,
           "; give it a range in its <limit>, or make it fixed");
    }
    if (!std::isfinite(joint.max_speed)) {
      fail(model.source(), ": joint '", joint.name, "' has no speed limit; add velocity to its <limit>");
    }
    limits.lowest_rad[i] = std::max(joint.lower, -kNoEnd_rad);
    limits.highest_rad[i] = std::min(joint.upper, kNoEnd_rad);
    limits.velocity_rad_s[i] = joint.max_speed;
  }
  validate(limits);
  return limits;
}

}  // namespace depthgrid::avoidance
