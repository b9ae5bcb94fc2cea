// How noisy a depth camera is, judged from its own images.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"
#include "program/info/histogram.hpp"

namespace depthgrid::program {

/// Residuals of each pixel's depth to the straight line through its neighbours, by depth.
///
/// On a plane 1/z is linear in the image, so 1/z - (1/z_left + 1/z_right)/2 is noise alone; times z^2 it is metres of
/// depth, and times sqrt(2/3) the noise of one pixel where the three are independent. Rows and columns are both used,
/// neighbours are four pixels away, and places where they differ by more than 3 % of the depth (edges) are left out.
/// Noise that neighbours share, and any bias, cannot be seen this way.
class DepthNoise {
 public:
  void add(const DepthImage& depth);

  /// m(D) = constant + quadratic D^2 that lies nowhere below the 95 % quantile of a half-metre slice (slices with less
  /// than 1000 residuals are left out) and exceeds them by the least sum. Zero without residuals.
  [[nodiscard]] SensorMargin suggested_margin() const;

 private:
  std::vector<Histogram> slices_;
};

}  // namespace depthgrid::program
