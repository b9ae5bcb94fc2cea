// What is assumed of common depth sensors: margins, measurable range and exposure. Sources and how far each number can
// be trusted stand in docs/sensor-models.md.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"

namespace depthgrid {

/// Every model's depth margin covers this many standard deviations of the noise, half a quantisation step and the
/// systematic error that the sensor's maker states. That real readings stay within it is an assumption about the
/// sensor.
inline constexpr double kSensorSigmas = 3.0;

/// Depth from disparity: sigma(z) = z^2 subpixel_px / (f b), and a step of disparity is worth z^2 step_px / (f b).
struct StereoNoise {
  double baseline_m;
  double subpixel_px;       ///< standard deviation of the disparity
  double step_px;           ///< quantisation of the disparity
  double largest_focal_px;  ///< of the largest image the sensor computes: a larger one was interpolated
};

struct SensorModel {
  std::string_view name;         ///< for instance "realsense_d435"
  std::string_view description;  ///< one line
  /// What does not depend on the camera's calibration; use sensor_margins(), which adds what does.
  SensorMargin margin;
  std::optional<StereoNoise> stereo;
  bool rounds_to_units = false;  ///< half of the image's metres_per_unit belongs to the margin, too
  /// near_m = 0 and an infinite far_m: nothing is assumed.
  MeasurementRule rule;
  /// Half the time in which one image is taken; none: not known.
  std::optional<double> half_exposure_s;
  /// Error of a time stamp taken as the model's page says; none: not known.
  std::optional<double> time_uncertainty_s;
  /// What CameraMargins::smallest_obstacle_m may be where nothing speaks against it, metres: at the image's full width.
  /// It says something of obstacles, not of the sensor, so sensor_margins() does not declare it.
  double smallest_obstacle_m = 0;
  /// CameraMargins::second_view_x_m of images as the sensor computed them; 0: it has none. Whether images were
  /// registered to another camera is not the model's to say, so sensor_margins() leaves it out, too.
  double second_view_x_m = 0;
};

/// All models. The first one is "ideal": no noise, as rendered images have it.
[[nodiscard]] std::span<const SensorModel> sensor_models() noexcept;

/// The model called `name`; hyphens count as underscores. Throws Error that lists the names there are.
[[nodiscard]] const SensorModel& sensor_model(std::string_view name);

/// The errors of one camera of this model. `camera` as calibrated for its depth images, not for images that were
/// registered to another camera; `metres_per_unit` of its 16-bit images. What the model does not know, and everything
/// that is a matter of calibration, is 0. Not among them: the range, so readings beyond it are believed unless
/// RigCamera::rule is set to model.rule; the smallest obstacle, which stays undeclared; and the second view.
[[nodiscard]] CameraMargins sensor_margins(const SensorModel& model, const PinholeCamera& camera,
                                           double metres_per_unit) noexcept;

}  // namespace depthgrid
