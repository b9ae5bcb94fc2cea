#include "depthgrid/simulation/surface_slant.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace depthgrid::simulation {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Arc tangent of t >= 0 to 1e-5 (Abramowitz and Stegun 4.4.49).
float arc_tangent(float t) {
  const bool steep = t > 1;
  const float x = steep ? 1 / t : t;
  const float x2 = x * x;
  const float small = x * (0.9998660F + x2 * (-0.3302995F + x2 * (0.1801410F + x2 * (-0.0851330F + x2 * 0.0208351F))));
  return steep ? 0.5F * std::numbers::pi_v<float> - small : small;
}

/// Slope of the inverse depth, which is linear in the image on a plane, from the flatter side; 0 without neighbours.
/// An inverse depth of 0 is none.
float slope(float before, float here, float after) {
  const float from_before = before > 0 ? here - before : kFar;
  const float to_after = after > 0 ? after - here : kFar;
  const float flatter = std::abs(from_before) < std::abs(to_after) ? from_before : to_after;
  return std::abs(flatter) < kFar ? flatter : 0.0F;
}

}  // namespace

void surface_slants(const PinholeCamera& camera, const DepthImage& depth_m, std::vector<float>& slant_rad) {
  const int width = depth_m.width_px();
  const int height = depth_m.height_px();
  slant_rad.assign(depth_m.index(0, height), 0.0F);
  DepthImage inverse(width, height);
  std::transform(depth_m.data(), depth_m.data() + slant_rad.size(), inverse.data(),
                 [](float z) { return z > 0 ? 1 / z : 0.0F; });
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  for (int v = 0; v < height; ++v) {
    const float* const here = inverse.data() + inverse.index(0, v);
    const float* const above = v > 0 ? here - width : nullptr;
    const float* const below = v + 1 < height ? here + width : nullptr;
    float* const slant = slant_rad.data() + inverse.index(0, v);
    const float y = (static_cast<float>(v) + 0.5F - static_cast<float>(camera.cy_px)) / fy;
    for (int u = 0; u < width; ++u) {
      if (here[u] <= 0) {
        continue;
      }
      // On a plane n . p = 1 a ray r = (x, y, 1) has 1/z = n . r, and x and y are linear in the pixel.
      const float nx = fx * slope(u > 0 ? here[u - 1] : 0, here[u], u + 1 < width ? here[u + 1] : 0);
      const float ny = fy * slope(above != nullptr ? above[u] : 0, here[u], below != nullptr ? below[u] : 0);
      const float x = (static_cast<float>(u) + 0.5F - static_cast<float>(camera.cx_px)) / fx;
      const float nz = here[u] - nx * x - ny * y;
      const Eigen::Vector3f across = Eigen::Vector3f(nx, ny, nz).cross(Eigen::Vector3f(x, y, 1));
      slant[u] = arc_tangent(across.norm() / here[u]);
    }
  }
}

void EdgeDepths::update(const DepthImage& depth_m) {
  const auto width = static_cast<std::size_t>(depth_m.width_px());
  const auto height = static_cast<std::size_t>(depth_m.height_px());
  for (std::vector<float>* buffer : {&near_m_, &far_m_, &row_near_m_, &row_far_m_}) {
    buffer->resize(width * height);
  }
  // Along the rows, then along the columns; for the nearest, no depth is infinitely far.
  const auto none_is_far = [](float z) {
    if (z > 0) {
      return z;
    }
    return kFar;
  };
  for (std::size_t v = 0; v < height; ++v) {
    const float* const z = depth_m.data() + v * width;
    for (std::size_t u = 0; u < width; ++u) {
      const float left = z[u > 0 ? u - 1 : u];
      const float right = z[u + 1 < width ? u + 1 : u];
      row_near_m_[v * width + u] = std::min({none_is_far(left), none_is_far(z[u]), none_is_far(right)});
      row_far_m_[v * width + u] = std::max({left, z[u], right});
    }
  }
  for (std::size_t v = 0; v < height; ++v) {
    const std::size_t above = (v > 0 ? v - 1 : v) * width;
    const std::size_t here = v * width;
    const std::size_t below = (v + 1 < height ? v + 1 : v) * width;
    for (std::size_t u = 0; u < width; ++u) {
      const float nearest = std::min({row_near_m_[above + u], row_near_m_[here + u], row_near_m_[below + u]});
      near_m_[here + u] = nearest < kFar ? nearest : 0.0F;
      far_m_[here + u] = std::max({row_far_m_[above + u], row_far_m_[here + u], row_far_m_[below + u]});
    }
  }
}

}  // namespace depthgrid::simulation
