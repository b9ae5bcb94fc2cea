// What an evaluator says about one point, sphere or capsule.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "depthgrid/core/proximity.hpp"

namespace depthgrid {

/// - Frame and unit: world, metres; directions have no unit.
/// - What was not asked for, or does not exist, keeps its initial value.
struct Answer {
  /// From the capsule's surface to the nearest obstacle, at the time of the images. The search: to the obstacle set O,
  /// 0 where they touch; nearest_world to the resolution, at most 1 mm beside W; direction_world from the axis to it.
  Proximity nearest;
  /// A lower bound at the time asked for: lower_bound_after(nearest, age of the images, v_max). NaN where nothing is
  /// known, or where no time was asked for (search::Search).
  double distance_now_m = Proximity::kNaN;
  /// The axis' point nearest to nearest.nearest_world; the point itself for a point or a sphere. NaN where there is no
  /// nearest point.
  Eigen::Vector3d on_axis_world = Eigen::Vector3d::Constant(Proximity::kNaN);
  /// Equation (11), where it was asked for. Corrected form (search, and grid `corrected`): unit vector
  /// n + b (t - (t.n) n), normalised, with n the nearest direction and t the mean of the unit vectors to all obstacles
  /// within rho, weighted by the repulsion v(D); its product with n is at least 0.707. Grid `letter`: the mean of the
  /// unit vectors as printed, not normalised. Zero where nothing is within rho or the capsule touches an obstacle.
  Eigen::Vector3d hybrid_direction_world = Eigen::Vector3d::Zero();
  /// N of (11): principal pixels with an obstacle within rho. The grid's hybrid only.
  std::int64_t obstacle_points = 0;
  /// How thick the layer around the robot is in which nothing is seen: the distances above are bounds for everything
  /// that was farther than this from every part of the robot when the images were exposed and that the policies do not
  /// ignore (pockets behind the robot, space that nobody looks at); with a memory, when any image so far was. What is
  /// nearer may have been taken for the robot, and be missing from them. Metres, of the camera and part where it is
  /// thickest, errors of calibration and of pixels included. 0 where no image had the robot removed; NaN where
  /// somebody's RobotView does not state it, or nothing was evaluated.
  double blind_m = Proximity::kNaN;
};

/// How far the blind layer is from the nearest obstacle that may stand outside of it, at the time asked for:
/// max(0, distance_now_m - blind_m), metres. A robot that keeps this above 0 never takes its layer over something that
/// it saw. 0: the distance says nothing. NaN where the distance or the layer is not known.
[[nodiscard]] double clear_of_layer_m(const Answer& answer) noexcept;

}  // namespace depthgrid
