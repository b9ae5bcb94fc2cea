// Small capsules around points and simple solids.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/robot/robot_description.hpp"

namespace depthgrid::robot {

/// A capsule that contains all points, and so everything between them, of nearly the least volume: found by descent
/// from several starts, not proven. The same points give the same capsule. Throws Error when there is no point or one
/// is not finite.
[[nodiscard]] Capsule fit_capsule(std::span<const Eigen::Vector3d> points);

/// The capsule of least volume among those with the cylinder's axis; frame of the cylinder.
[[nodiscard]] Capsule around(const CylinderShape& cylinder);

/// Capsules that together contain the box: side by side along its longest side, so many that each one's part is about
/// as wide as thick, at most eight. Frame of the box.
[[nodiscard]] std::vector<Capsule> around(const BoxShape& box);

}  // namespace depthgrid::robot
