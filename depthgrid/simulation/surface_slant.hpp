// What a depth image tells about the surface in each pixel: how steep it is, and whether it ends there.
#pragma once

#include <cstddef>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"

namespace depthgrid::simulation {

/// Angle between the surface's normal and the ray of each pixel, in [0, pi/2], from the flatter one of the
/// differences to either side in row and column. Exact to 1e-4 rad on planes; 0 where there is no depth.
void surface_slants(const PinholeCamera& camera, const DepthImage& depth_m, std::vector<float>& slant_rad);

/// Nearest and farthest depth in the 3 x 3 pixels around each one; pixels without depth do not count, and without any
/// both are 0.
class EdgeDepths {
 public:
  void update(const DepthImage& depth_m);

  [[nodiscard]] float near_m(std::size_t pixel) const noexcept { return near_m_[pixel]; }
  [[nodiscard]] float far_m(std::size_t pixel) const noexcept { return far_m_[pixel]; }
  /// They differ by more than 4 % and 3 cm: more than a steep surface does within three pixels.
  [[nodiscard]] bool is_edge(std::size_t pixel) const noexcept {
    return far_m_[pixel] > 1.04F * near_m_[pixel] && far_m_[pixel] - near_m_[pixel] > 0.03F;
  }

 private:
  std::vector<float> near_m_;
  std::vector<float> far_m_;
  std::vector<float> row_near_m_;
  std::vector<float> row_far_m_;
};

}  // namespace depthgrid::simulation
