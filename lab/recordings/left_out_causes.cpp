#include "lab/recordings/left_out_causes.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::lab {

namespace {

constexpr int kEdgeRadius_px = 3;
constexpr float kEdgeStep = 0.04F;
constexpr float kMoved_m = 0.10F;
constexpr double kThrough_m = 0.30;

}  // namespace

std::string_view to_string(LeftOutCause cause) {
  switch (cause) {
    case LeftOutCause::moved:
      return "off its pixel's median";
    case LeftOutCause::own_edge:
      return "edge in its own image";
    case LeftOutCause::freeing_edge:
      return "edge in the freeing image";
    case LeftOutCause::background_seen:
      return "seen through, 0.3 m and more";
    case LeftOutCause::offset:
      return "smooth, offset";
  }
  return "?";
}

DepthImage median_image(std::span<const DepthImage> images) {
  if (images.empty()) {
    return {};
  }
  DepthImage median(images.front().width_px(), images.front().height_px());
  std::vector<float> values;
  for (int v = 0; v < median.height_px(); ++v) {
    for (int u = 0; u < median.width_px(); ++u) {
      values.clear();
      for (const DepthImage& image : images) {
        if (image.at(u, v) > 0) {
          values.push_back(image.at(u, v));
        }
      }
      if (!values.empty()) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        median.at(u, v) = *middle;
      }
    }
  }
  return median;
}

bool at_edge(const DepthImage& depth, int u, int v) {
  const float centre_m = depth.at(u, v);
  for (int j = v - kEdgeRadius_px; j <= v + kEdgeRadius_px; ++j) {
    for (int i = u - kEdgeRadius_px; i <= u + kEdgeRadius_px; ++i) {
      if (i < 0 || j < 0 || i >= depth.width_px() || j >= depth.height_px() || !(depth.at(i, j) > 0) ||
          std::abs(depth.at(i, j) - centre_m) > kEdgeStep * centre_m) {
        return true;
      }
    }
  }
  return false;
}

LeftOutCause cause_of(const LeftOutReading& reading, const DepthImage& left_out, const DepthImage& median,
                      const DepthImage& freeing) {
  if (median.width_px() > 0 && median.at(reading.u, reading.v) > 0 &&
      std::abs(median.at(reading.u, reading.v) - reading.depth_m) > kMoved_m) {
    return LeftOutCause::moved;
  }
  if (at_edge(left_out, reading.u, reading.v)) {
    return LeftOutCause::own_edge;
  }
  if (at_edge(freeing, reading.known_free_u, reading.known_free_v)) {
    return LeftOutCause::freeing_edge;
  }
  return reading.gap_m >= kThrough_m ? LeftOutCause::background_seen : LeftOutCause::offset;
}

}  // namespace depthgrid::lab
