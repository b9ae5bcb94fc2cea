// What a memory keeps and how it begins. Nothing that decides what may be where has a silent default.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <variant>
#include <vector>

#include "depthgrid/core/capsule.hpp"

namespace depthgrid::memory {

/// At the start something may be anywhere: only what cameras see free becomes free.
struct StartUnknown {};

/// Declared: at the first image nothing but the robot was within distance_m of its surface.
struct StartEmptyAroundRobot {
  std::vector<Capsule> robot_world;
  double distance_m = 0;
};

/// Declared: at the first image nothing was in the region that cameras do not see.
struct StartEmpty {};

/// - Units and frame: metres, world.
/// - To be set: the region and the start. The rest has defaults.
/// - Errors: validate() throws Error.
struct MemorySettings {
  /// The kept region; what lies outside of it may be occupied, always. Enlarged to whole blocks of four voxels. The
  /// robot's surroundings cost less than the cell.
  Eigen::Vector3d low_world = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d high_world = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::variant<std::monostate, StartUnknown, StartEmptyAroundRobot, StartEmpty> start;  ///< has to be set
  double voxel_m = 0.025;
  /// Every obstacle consists of balls of this diameter, also where no camera sees it: thinner things that are hidden
  /// may be missed. 0 claims nothing.
  double thinnest_hidden_m = 0;
};

/// Throws Error with value, rule and hint unless every part is set and in range.
void validate(const MemorySettings& settings);

}  // namespace depthgrid::memory
