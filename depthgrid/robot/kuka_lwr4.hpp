// The KUKA LWR 4+.
#pragma once

#include <string_view>

#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::robot {

/// The project's own URDF of the arm, share/robots/kuka_lwr4.urdf: what it says and leaves out stands at its beginning.
/// Seven joints, the flange is link `lwr_7_link`, eight capsules.
[[nodiscard]] std::string_view kuka_lwr4_urdf() noexcept;

[[nodiscard]] RobotModel kuka_lwr4();

}  // namespace depthgrid::robot
