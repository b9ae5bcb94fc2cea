// How near to one primitive a camera may have something blocked, box by box.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "reference/camera_space.hpp"

namespace depthgrid::reference {

/// For one primitive and one camera, which must outlive it. Distances between the primitive's axis and the pixels' not
/// free pieces are computed when they are asked for and kept. Not for two threads at once.
class Nearness {
 public:
  /// Blocked points at enough_m or farther are not told apart.
  Nearness(const CameraSpace& camera, const Primitive& primitive, double enough_m);

  /// Proven: no point of the box (or, with `limits`, no point of it in this camera's view between the two depths) that
  /// the camera blocks is nearer to the axis than this; infinite: it blocks none. 0 when nothing can be said.
  /// A result of at most useless_m stands for "no more than that is known".
  [[nodiscard]] double of_blocked_m(const WorldBox& box, const std::optional<ViewLimits>& limits, double useless_m);

  /// A point that the camera probably blocks, where the last result was finite and not useless: what decided it.
  [[nodiscard]] const std::optional<Eigen::Vector3d>& suspect_world() const { return suspect_world_; }

 private:
  struct Known {
    double distance_m = std::numeric_limits<double>::quiet_NaN();
    Eigen::Vector3f nearest = Eigen::Vector3f::Zero();  ///< of the piece, camera frame; only a suspect
  };

  /// From the axis to the i-th not known free piece of a pixel; a lower bound.
  const Known& piece_distance(int u, int v, std::size_t i, const std::array<double, 2>& depths);

  const CameraSpace* camera_;
  Eigen::Vector3d a_camera_, b_camera_;
  double enough_m_;
  double farthest_m_;                 ///< depth beyond which nothing is nearer to the axis than enough_m
  std::array<double, 4> border_m_{};  ///< from the axis to what lies beyond the image's four borders
  CameraSpace::PixelWindow kept_{};   ///< pixels whose distances are kept: a rectangle inside the image
  std::vector<std::array<Known, 4>> known_;
  std::array<Known, 4> unkept_;
  std::optional<Eigen::Vector3d> suspect_world_;
};

}  // namespace depthgrid::reference
