#include "lab/peers/masked_image.hpp"

#include <cstddef>

namespace depthgrid::lab {
namespace {

/// Calls replace(depth, near, far) for all pixels, row by row.
template <class Replace>
void for_each_pixel(const Frame& frame, const MeasurementRule& rule, DepthImage& image, Replace replace) {
  normalise(frame.depth, rule, image);
  if (frame.robot.near_m == nullptr) {
    return;
  }
  const std::ptrdiff_t stride = frame.robot.stride_px != 0 ? frame.robot.stride_px : image.width_px();
  for (int v = 0; v < image.height_px(); ++v) {
    float* depth_m = image.data() + image.index(0, v);
    const float* near_m = frame.robot.near_m + v * stride;
    const float* far_m = frame.robot.far_m + v * stride;
    for (int u = 0; u < image.width_px(); ++u) {
      const bool robot = near_m[u] > 0.0F && near_m[u] <= depth_m[u] && depth_m[u] <= far_m[u];
      depth_m[u] = robot ? replace(far_m[u]) : depth_m[u];
    }
  }
}

}  // namespace

void robot_removed(const Frame& frame, const MeasurementRule& rule, DepthImage& depth_m) {
  for_each_pixel(frame, rule, depth_m, [](float) { return 0.0F; });
}

void robot_looked_through(const Frame& frame, const MeasurementRule& rule, DepthImage& free_m) {
  for_each_pixel(frame, rule, free_m, [](float far_m) { return far_m; });
}

}  // namespace depthgrid::lab
