// One function a format. Internal to the import.
#pragma once

#include <initializer_list>
#include <vector>

#include "program/rig/imported_camera.hpp"
#include "program/rig/yaml_value.hpp"

namespace depthgrid::program {

/// Each throws Error that names the place. `stem`: a name for a camera that has none.
[[nodiscard]] std::vector<ImportedCamera> of_camera_info(const YamlValue& file, const std::string& stem,
                                                         const ImportOptions& options);
[[nodiscard]] std::vector<ImportedCamera> of_kalibr(const YamlValue& file);
[[nodiscard]] std::vector<ImportedCamera> of_open3d(const YamlValue& file, const std::string& stem);
[[nodiscard]] std::vector<ImportedCamera> of_azure_kinect(const YamlValue& file, const std::string& stem,
                                                          const ImportOptions& options);

/// Refuses with "PLACE: `form`" unless the entries `zeros` of a matrix are 0 and the entry `one` is 1: then its focal
/// lengths and its principal point stand where they are looked for.
void check_zeros_and_one(const YamlValue& place, const std::vector<double>& numbers,
                         std::initializer_list<std::size_t> zeros, std::size_t one, const char* form);

/// The intrinsics, with the place in front of an error. The principal point counts from the centre of the first pixel.
[[nodiscard]] PinholeCamera imported_intrinsics(const YamlValue& place, int width_px, int height_px, double fx_px,
                                                double fy_px, double cx_px, double cy_px);

/// By the name that ROS, OpenCV and Kalibr give the model. Zeros behind the coefficients that a model has, and
/// coefficients that are all 0 or not there, are taken for what they mean.
[[nodiscard]] Distortion imported_distortion(const YamlValue& place, const std::string& model,
                                             std::vector<double> coefficients);

/// A rigid transform of 16 numbers, row after row.
[[nodiscard]] Pose imported_pose(const YamlValue& place, const std::vector<double>& rows);

}  // namespace depthgrid::program
