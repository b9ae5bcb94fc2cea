// Margins that turn a measured depth into the depth up to which space is known to be free.
#pragma once

#include <limits>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"

namespace depthgrid {

/// m(D) = constant + linear D + quadratic D^2 [m]: noise plus half a quantisation step at depth D; and the lateral
/// filter radius w in pixels within which a nearer surface may hide.
struct SensorMargin {
  double constant_m = 0.0;
  double linear = 0.0;
  double quadratic_per_m = 0.0;
  int lateral_px = 1;
};

/// Calibration and time: e(x) = translation_m + rotation_rad |x - camera centre| + time_m, where
/// time_m = motion_margin_m() of v_max (|t_k - t_ref| + half the exposure + time-stamp uncertainty). A point is known
/// free to a camera only if the whole ball of radius e around it is free in that camera.
struct PoseMargin {
  double translation_m = 0.0;
  double rotation_rad = 0.0;
  double time_m = 0.0;
};

/// What is known of the errors of one camera and its clock, which together with the fastest obstacle gives a
/// PoseMargin; and what is assumed of obstacles where it has no reading.
struct CameraMargins {
  SensorMargin sensor;            ///< m_k and w_k
  double translation_m = 0;       ///< calibration: the camera's position
  double rotation_rad = 0;        ///< calibration: the camera's orientation
  double half_exposure_s = 0;     ///< half the time in which one image is taken
  double time_uncertainty_s = 0;  ///< error of the time stamp
  /// s: every obstacle is a union of balls of this diameter, metres, so a small hole in the image may count as what
  /// surrounds it (docs/smallest-obstacle.md). What is smaller may be missed where it gives no reading. 0: nothing is
  /// assumed, a pixel without reading frees nothing. NaN: not declared, which the search refuses.
  double smallest_obstacle_m = std::numeric_limits<double>::quiet_NaN();
  /// Where the sensor's second view stands, its projector or other imager, along the image's x axis: metres, positive
  /// to the right. Then the shadow bands of near things, in which the sensor cannot measure, count as what may be
  /// hidden there. For images as the sensor computed them only; in those that were registered to another camera the
  /// bands lie elsewhere. 0: bands are holes like others.
  double second_view_x_m = 0;
};

/// Throws Error unless all parts are finite and not negative (a smallest obstacle that is not declared passes, and the
/// second view may stand to the left) and lateral_px is in [0, 16].
void validate(const SensorMargin& margin, const char* name = "sensor margin");
void validate(const PoseMargin& margin, const char* name = "pose margin");
void validate(const CameraMargins& margins, const char* name = "camera margins");

/// What a way that something may have gone adds to e, metres: from there the camera's rotation error turns it by more.
[[nodiscard]] inline double motion_margin_m(const CameraMargins& margins, double way_m) noexcept {
  return way_m * (1 + margins.rotation_rad);
}

/// m(D) for a measured depth, metres.
[[nodiscard]] inline double depth_margin_m(const SensorMargin& margin, double depth_m) noexcept {
  return margin.constant_m + depth_m * (margin.linear + depth_m * margin.quadratic_per_m);
}

/// The depth g up to which each pixel's frustum is known to be free: the minimum over the (2w+1)^2 neighbourhood of
/// D - m(D), where a pixel without measurement and every pixel outside the image count as 0 (so with w >= 1 the w
/// outermost rows and columns are 0); with lateral_px = 0 the pixel alone counts. Robot pixels contribute the robot's
/// exit far_m instead of D - m(D): those whose own measured depth lies in the robot's interval, near_m <= D - m(D) and
/// D <= far_m, with 0 < near_m and a finite far_m. Result: metres, never above the exact value (rounded towards zero),
/// never negative; 0 = nothing is free. Buffers are allocated by the constructor only.
class FreeDepth {
 public:
  /// Throws Error on a size outside [1, kLargestImageSide] or as validate(). Until the first update nothing is free.
  FreeDepth(int width_px, int height_px, const SensorMargin& margin);

  /// `measured` (0 = no measurement) and `robot` have the size given to the constructor; with a `measured` of another
  /// size nothing is free. Does not allocate. Not for two threads at once on one object.
  void update(const DepthImage& measured, const RobotView& robot) noexcept;

  [[nodiscard]] const DepthImage& image() const noexcept { return free_m_; }

 private:
  SensorMargin margin_;
  DepthImage reduced_m_;
  DepthImage row_minimum_m_;
  DepthImage free_m_;
};

}  // namespace depthgrid
