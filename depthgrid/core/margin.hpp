// Margins that turn a measured depth into the depth up to which space is known to be free.
#pragma once

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
/// time_m = v_max (|t_k - t_ref| + half the exposure + time-stamp uncertainty). A point is known free to a camera only
/// if the whole ball of radius e around it is free in that camera.
struct PoseMargin {
  double translation_m = 0.0;
  double rotation_rad = 0.0;
  double time_m = 0.0;
};

/// What is known of the errors of one camera and its clock. Together with the fastest obstacle this gives a PoseMargin.
struct CameraMargins {
  SensorMargin sensor;            ///< m_k and w_k
  double translation_m = 0;       ///< calibration: the camera's position
  double rotation_rad = 0;        ///< calibration: the camera's orientation
  double half_exposure_s = 0;     ///< half the time in which one image is taken
  double time_uncertainty_s = 0;  ///< error of the time stamp
};

/// Throws Error unless all parts are finite and not negative and lateral_px is in [0, 16].
void validate(const SensorMargin& margin, const char* name = "sensor margin");
void validate(const PoseMargin& margin, const char* name = "pose margin");
void validate(const CameraMargins& margins, const char* name = "camera margins");

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
