// Whether an answer is more than the truth, with the one exception that is documented: the blind layer.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "world/world.hpp"

namespace depthgrid::world {

/// Where readings within their margin of the robot count as the robot's, what stands before it may be taken for it: a
/// point from which a way of 2 m(D) along the camera's ray, D - m(D) being the point's depth, leads into the layer.
struct Sight {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_world = Eigen::Vector3d::UnitZ();
  SensorMargin sensor;

  /// That way.
  [[nodiscard]] Capsule way(const Eigen::Vector3d& at) const;
};

/// An image behind an answer: when it was exposed, and where the robot was taken to stand.
struct Look {
  double from_s = 0;
  double to_s = 0;
  std::vector<Capsule> robot;
  double blind_m = 0;  ///< how thick the layer was then, where that is more than what the answer says
  std::optional<Sight> sight{};
};

struct Verdict {
  double truth_m = 0;  ///< to the nearest of everything
  /// By how much the answer is above the distance to something that counts; none: it is not.
  std::optional<double> excess_m;
  bool in_layer = false;  ///< the answer is above the truth, but all that was found nearer is in the blind layer
};

/// Judges an answer for this time. What counts is everything "farther than blind_m from every part of the robot when
/// the images were exposed", and not before this layer within its sight, point by point: a point of a solid keeps its
/// place in the solid. Points are sought on and
/// below the surfaces that are nearer than the answer; a blind_m that is not a number exempts nothing, and one of 0
/// only what touched the robot.
[[nodiscard]] Verdict judge(const World& world, const Capsule& asked, double answer_m, double time_s, double blind_m,
                            std::span<const Look> looks);

}  // namespace depthgrid::world
