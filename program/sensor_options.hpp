// The options of the command line that say how far cameras may err and what they can measure.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::program {

/// As given; what is absent is the sensor model's, else the rig file's.
struct SensorOptions {
  std::optional<std::string> sensor;
  std::optional<double> margin_constant_m;
  std::optional<double> margin_linear;
  std::optional<double> margin_quadratic_per_m;
  std::optional<int> margin_lateral_px;
  std::optional<double> margin_translation_m;
  std::optional<double> margin_rotation_rad;
  std::optional<double> margin_time_m;
  std::optional<double> half_exposure_s;
  std::optional<double> time_uncertainty_s;

  std::optional<double> near_m;
  std::optional<double> far_m;
  std::optional<std::string> beyond_far;  ///< invalid or clamp
};

void add_sensor_options(CLI::App& command, SensorOptions& options);

/// Whether a --margin-... option or one about the exposure was given.
bool names_margins(const SensorOptions& options) noexcept;

/// One a camera, in the rig's order: the rig file's, the noise of --sensor in its place, and single numbers of the
/// command line in place of both. --margin-time counts as a part of the translation, which it adds up with. A camera of
/// which nothing is said is ideal, or refused with UsageError where `must_be_stated`. Throws Error where a value breaks
/// a rule.
std::vector<CameraMargins> camera_margins(const SensorOptions& options, const Rig& rig, bool must_be_stated);

/// Nearest and farthest measurable depth: the user's, else the sensor model's, else nothing (the rig file's own).
std::optional<double> near_limit_m(const SensorOptions& options);
std::optional<double> far_limit_m(const SensorOptions& options);

/// The filter radius: the user's, else the sensor model's, else nothing (the rig file's own).
std::optional<int> filter_radius_px(const SensorOptions& options);

/// Whether readings beyond the far limit count as that limit: as the user says, else as the sensor model does where the
/// limit is the model's, else nothing (the rig file's own).
std::optional<bool> clamp_beyond_far(const SensorOptions& options);

}  // namespace depthgrid::program
