#include "program/info/clamped_readings.hpp"

#include "depthgrid/core/rounding.hpp"

namespace depthgrid::program {

std::int64_t remove_clamped(const MeasurementRule& rule, DepthImage& depth) noexcept {
  if (!rule.clamp_beyond_far) {
    return 0;
  }
  const float far_m = nearest_float(rule.far_m);
  const std::size_t size = depth.index(0, depth.height_px());
  std::int64_t clamped = 0;
  for (std::size_t i = 0; i < size; ++i) {
    float& depth_m = depth.data()[i];
    if (depth_m >= far_m) {
      depth_m = 0.0F;
      ++clamped;
    }
  }
  return clamped;
}

}  // namespace depthgrid::program
