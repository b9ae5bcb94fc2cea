// Depth sensors in simulation: how an ideal depth image becomes one that a sensor would give. The numbers and where
// they come from stand in docs/simulation.md.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/simulation/surface_slant.hpp"

namespace depthgrid::simulation {

/// What a simulated sensor does to an ideal image. All zero and infinite: nothing.
struct SensorSimulation {
  std::string name = "ideal";

  /// Axial noise: standard deviation constant + quadratic (z - origin)^2 + slant_factor / sqrt(z) theta^2 / (pi/2 -
  /// theta)^2, theta the angle between the surface's normal and the ray, at most largest_slant_rad.
  double noise_constant_m = 0;
  double noise_quadratic_per_m = 0;
  double noise_origin_m = 0;
  double noise_slant = 0;  ///< [m^1.5]

  /// Lateral noise: a pixel shows what an ideal one would show that lies beside it by normal offsets in column and row
  /// of this standard deviation: constant + slant theta / (pi/2 - theta). Offsets beyond the limit are cut off there.
  double lateral_px = 0;
  double lateral_slant_px = 0;
  double lateral_limit_px = 16;

  int patch_px = 1;  ///< noise is the same within squares of this side

  double step_per_m = 0;  ///< quantisation: 1/z comes in whole multiples of this; 0: not quantised

  /// Systematic error: a smooth function of the pixel between -1 and 1, another one for each unit, times constant +
  /// linear z.
  double bias_constant_m = 0;
  double bias_linear = 0;

  double baseline_m = 0;  ///< of the second view that must see a surface too (to the right); 0: there is none
  double flying_share =
      0;  ///< of the pixels within one of an edge: read anywhere between its nearest and farthest depth
  double dropout_share = 0;                       ///< of all pixels, each for itself: without measurement
  double largest_slant_rad = 1.5707963267948966;  ///< steeper surfaces give no measurement

  double near_m = 0;  ///< readings outside [near_m, far_m] are none
  double far_m = std::numeric_limits<double>::infinity();

  bool structured_light = false;  ///< disturbed by others of its kind, see interference.hpp
  double vibration_px = 0;        ///< the whole image is displaced by up to this, another way in every frame
};

/// The simulation that belongs to the sensor model of that name (depthgrid::sensor_model), as calibrated for `camera`.
/// Throws Error on a name that is none.
[[nodiscard]] SensorSimulation sensor_simulation(std::string_view model_name, const PinholeCamera& camera);

/// The stated standard deviation of the axial noise at depth z and slant theta, metres.
[[nodiscard]] double noise_sigma_m(const SensorSimulation& sensor, double depth_m, double slant_rad = 0) noexcept;

/// One unit. The same seed, frame number and ideal image give the same image, whatever was measured before.
class SimulatedSensor {
 public:
  /// Throws Error when the camera is invalid, a number of `sensor` is negative or not finite (far_m and
  /// largest_slant_rad aside), a share is above 1 or patch_px below 1.
  SimulatedSensor(SensorSimulation sensor, const PinholeCamera& camera, std::uint64_t seed);

  /// `ideal_m` has the camera's size and 0 where nothing is; `measured_m` is resized to it: metres, 0 = no measurement.
  /// Throws Error on another size. One thread at a time.
  void measure(const DepthImage& ideal_m, std::uint64_t frame, DepthImage& measured_m);

  [[nodiscard]] const SensorSimulation& sensor() const noexcept { return sensor_; }
  [[nodiscard]] const PinholeCamera& camera() const noexcept { return camera_; }
  [[nodiscard]] std::uint64_t seed() const noexcept { return seed_; }

 private:
  /// What is asked of a whole ideal image before its pixels.
  void look_at(const DepthImage& ideal_m);
  /// Column or row of the ideal pixel that one shows.
  [[nodiscard]] int beside(int at, double sigma_px, float normal, double shake_px, int size_px) const noexcept;
  [[nodiscard]] double reading_m(double ideal_m, std::size_t source, std::uint64_t dice) const noexcept;

  SensorSimulation sensor_;
  PinholeCamera camera_;
  std::uint64_t seed_;
  std::vector<float> bias_;  ///< the smooth function; empty without systematic error
  // Of the ideal image that is being measured.
  std::vector<std::uint8_t> hidden_;
  std::vector<float> slant_rad_;  ///< all 0 where the slant decides nothing
  EdgeDepths edges_;
};

/// The image as a sensor's driver delivers it: whole units, 0 where nothing was measured or the depth needs more than
/// 16 bits. Throws Error unless metres_per_unit is positive.
[[nodiscard]] std::vector<std::uint16_t> in_units(const DepthImage& depth_m, double metres_per_unit);

}  // namespace depthgrid::simulation
