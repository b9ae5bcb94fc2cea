#include <algorithm>
#include <cmath>
#include <filesystem>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "program/rig/formats.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

/// Runs a check of the library and puts the place in front of its message.
template <class Check>
auto with_place(const YamlValue& place, const Check& check) {
  try {
    return check();
  } catch (const Error& error) {
    fail(place.context(), error.what());
  }
}

std::vector<ImportedCamera> cameras_of(const YamlValue& file, const std::string& name, const ImportOptions& options) {
  const std::string stem = std::filesystem::path(name).stem().string();
  const auto has = [&file](const char* key) { return file.has(key); };
  if (has("CalibrationInformation")) {
    return of_azure_kinect(file, stem, options);
  }
  if (has("cam0")) {
    return of_kalibr(file);
  }
  if (has("intrinsic_matrix") || has("intrinsic") || has("parameters")) {
    return of_open3d(file, stem);
  }
  if (has("camera_matrix") || has("K") || has("k")) {
    return of_camera_info(file, stem, options);
  }
  if (has("cameras")) {
    fail(name, ": is a rig file already, see docs/rig-file.md");
  }
  fail(name,
       ": is no calibration that is known here: ROS camera_info (camera_matrix or K), Kalibr camchain (cam0), Open3D "
       "(intrinsic_matrix, intrinsic) or Azure Kinect (CalibrationInformation)");
}

/// What the rig file would refuse later, where nobody knows any more which file said it.
void check_plausible(const YamlValue& file, const ImportedCamera& camera) {
  with_place(file, [&] {
    const std::string name = "camera '" + camera.id + "'";
    depthgrid::check_plausible(camera.intrinsics, camera.distortion, name.c_str());
    for (const auto& pose : {camera.T_world_camera, camera.T_previous_camera}) {
      if (pose) {
        depthgrid::check_plausible(*pose, name.c_str());
      }
    }
  });
}

}  // namespace

void check_zeros_and_one(const YamlValue& place, const std::vector<double>& numbers,
                         std::initializer_list<std::size_t> zeros, std::size_t one, const char* form) {
  constexpr double kRounding = 1e-6;  // pixels
  const bool good = std::all_of(zeros.begin(), zeros.end(),
                                [&numbers](std::size_t k) { return std::abs(numbers.at(k)) <= kRounding; }) &&
                    std::abs(numbers.at(one) - 1.0) <= kRounding;
  if (!good) {
    fail(place.context(), form);
  }
}

PinholeCamera imported_intrinsics(const YamlValue& place, int width_px, int height_px, double fx_px, double fy_px,
                                  double cx_px, double cy_px) {
  return with_place(place, [&] { return from_opencv(width_px, height_px, fx_px, fy_px, cx_px, cy_px); });
}

Distortion imported_distortion(const YamlValue& place, const std::string& model, std::vector<double> coefficients) {
  const auto named = model.empty() ? Distortion::Model::none : distortion_model(model);
  if (!named) {
    fail(place.context(), "distortion model '", model,
         "' is not known, must be plumb_bob, radtan, rational_polynomial, equidistant or none; rectify the images "
         "first");
  }
  const bool equidistant = named == Distortion::Model::equidistant;
  const bool rational = named == Distortion::Model::rational;
  constexpr std::size_t kMost = 8;
  while (coefficients.size() > (equidistant ? 4 : rational ? kMost : 5) && coefficients.back() == 0.0) {
    coefficients.pop_back();
  }
  const bool zero = std::all_of(coefficients.begin(), coefficients.end(), [](double c) { return c == 0.0; });
  if (!equidistant && zero) {
    return {};
  }
  return with_place(place, [&] {
    const bool short_form = rational && (coefficients.size() == 4 || coefficients.size() == 5);  // k4 k5 k6 are 0
    return make_distortion(short_form ? Distortion::Model::plumb_bob : *named, coefficients);
  });
}

Pose imported_pose(const YamlValue& place, const std::vector<double>& rows) {
  return with_place(place, [&] {
    return pose_from_matrix(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data()), "matrix");
  });
}

std::vector<ImportedCamera> import_cameras(std::string_view text, const std::string& name,
                                           const ImportOptions& options) {
  const YamlValue file(text, name);
  std::vector<ImportedCamera> cameras = cameras_of(file, name, options);
  for (const ImportedCamera& camera : cameras) {
    if (options.rectified && camera.format != "ROS camera_info") {
      fail_usage("--rectified has no effect: it is for a ROS camera_info, and ", name, " is ", camera.format);
    }
    check_plausible(file, camera);
  }
  return cameras;
}

}  // namespace depthgrid::program
