// Whether one camera has seen a whole cell of the depth grid free: sufficient, so sound. Internal.
#pragma once

#include <Eigen/Core>
#include <array>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::grid {

/// A camera that may free cells. A cell is known free only if the cell, grown by the largest pose margin e in it, lies
/// wholly in front of the blind zone and inside the image, and the smallest free depth over every pixel that its
/// projection may touch lies behind the grown cell. (The letter compares one pixel's depth with the cell's smallest
/// depth instead, so a cell that holds the surface itself counts as free and thin things vanish.)
class CellCarver {
 public:
  /// `T_camera_principal` maps the principal camera's frame to this camera's. near_m: nothing nearer is known free.
  CellCarver(const PinholeCamera& camera, const Pose& T_camera_principal, double near_m, const PoseMargin& margin);

  /// The four edges of one principal pixel's pyramid in this camera's frame: a corner at principal depth d lies at
  /// d * edge + origin.
  using Edges = std::array<Eigen::Vector3d, 4>;
  [[nodiscard]] Edges edges(const PixelFrustum& pixel) const noexcept;

  /// True when the part of the pyramid between the depths d1_m and d2_m (finite) is free. free_m: this camera's free
  /// depth g.
  [[nodiscard]] bool frees(const Edges& edges, double d1_m, double d2_m, const DepthImage& free_m) const noexcept;

 private:
  struct Extent {
    double u_low, u_high, v_low, v_high, z_high;
  };
  [[nodiscard]] bool project(const Edges& edges, double d1_m, double d2_m, Extent& extent) const noexcept;

  PinholeCamera camera_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d origin_;
  double near_m_;
  PoseMargin margin_;
  bool has_margin_;
};

}  // namespace depthgrid::grid
