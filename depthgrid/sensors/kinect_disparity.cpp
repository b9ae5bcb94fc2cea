#include "depthgrid/sensors/kinect_disparity.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::sensors {

KinectDisparity::KinectDisparity(const KinectZeroPlane& plane) {
  constexpr double kSteps = 4;  // a pixel
  constexpr double kOffset_px = 0.375;
  constexpr double kScale = 10;
  for (std::size_t raw = 0; raw < table_.size(); ++raw) {
    const double shift_px = (static_cast<double>(raw) - kSteps * plane.shift) / kSteps - kOffset_px;
    const double metric = shift_px * plane.pixel_size_mm;
    const double depth_mm = kScale * (metric * plane.reference_distance_mm / (plane.emitter_distance_cm - metric) +
                                      plane.reference_distance_mm);
    if (metric < plane.emitter_distance_cm && depth_mm >= 1 && depth_mm <= kFarthest_mm) {
      table_[raw] = static_cast<std::uint16_t>(std::floor(depth_mm));
    }
  }
}

void KinectDisparity::convert(std::span<const std::uint16_t> raw, std::span<std::uint16_t> mm_out) const noexcept {
  const std::size_t count = std::min(raw.size(), mm_out.size());
  for (std::size_t k = 0; k < count; ++k) {
    mm_out[k] = mm(raw[k]);
  }
}

}  // namespace depthgrid::sensors
