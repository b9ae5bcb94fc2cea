// The calibration that an Azure Kinect holds and its SDK, Open3D and pyk4a write to a file. Numbers are divided by the
// sensor's size and count from the corner of the first pixel; each depth mode is another part of the sensor.
#include <algorithm>
#include <array>

#include "depthgrid/core/error.hpp"
#include "program/rig/formats.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

/// The sensor's size after binning, the first pixel of the image in it, and the image's size.
struct DepthMode {
  std::string_view name;
  int sensor_px, left_px, top_px, width_px, height_px;
};

constexpr std::array<DepthMode, 4> kModes{{{"nfov_unbinned", 1024, 192, 180, 640, 576},
                                           {"nfov_2x2binned", 512, 96, 90, 320, 288},
                                           {"wfov_unbinned", 1024, 0, 0, 1024, 1024},
                                           {"wfov_2x2binned", 512, 0, 0, 512, 512}}};

const DepthMode& mode_of(const YamlValue& file, const std::string& name) {
  const auto* const found =
      std::find_if(kModes.begin(), kModes.end(), [&name](const DepthMode& mode) { return mode.name == name; });
  if (found == kModes.end()) {
    fail_usage(
        file.context(), name.empty() ? "an Azure Kinect's calibration does not say" : "'" + name + "' is not",
        " which depth mode the images are of; give --depth-mode nfov_unbinned (640 x 576), nfov_2x2binned (320 x "
        "288), wfov_unbinned (1024 x 1024) or wfov_2x2binned (512 x 512)");
  }
  return *found;
}

YamlValue depth_camera(const YamlValue& cameras) {
  for (const YamlValue& camera : cameras.elements()) {
    if (camera.at("Location").text() == "CALIBRATION_CameraLocationD0") {
      return camera;
    }
  }
  fail(cameras.context(), "no camera has the Location CALIBRATION_CameraLocationD0, the depth camera");
}

}  // namespace

std::vector<ImportedCamera> of_azure_kinect(const YamlValue& file, const std::string& stem,
                                            const ImportOptions& options) {
  const YamlValue entry = depth_camera(file.at("CalibrationInformation").at("Cameras"));
  for (const char* side : {"SensorWidth", "SensorHeight"}) {
    if (entry.has(side) && entry.at(side).number() != 1024) {
      fail(entry.at(side).context(), "must be 1024, to which the depth modes belong");
    }
  }
  const DepthMode& mode = mode_of(file, options.depth_mode);
  const YamlValue intrinsics = entry.at("Intrinsics");
  const YamlValue parameters = intrinsics.at("ModelParameters");
  // cx cy fx fy k1 ... k6, the centre of distortion, p2 p1
  const std::vector<double> m = parameters.numbers(14);
  const std::string model = intrinsics.at("ModelType").text();
  const bool exact = model == "CALIBRATION_LensDistortionModelBrownConrady" ||
                     (model == "CALIBRATION_LensDistortionModelRational6KT" && m[12] == 0 && m[13] == 0);
  if (!exact || m[10] != 0 || m[11] != 0) {
    fail(intrinsics.context(), "model '", model,
         "' with these coefficients is not known, must be CALIBRATION_LensDistortionModelBrownConrady without a centre "
         "of "
         "distortion (the other model has another p1 and p2)");
  }
  ImportedCamera camera;
  camera.id = stem;
  camera.format = "Azure Kinect, " + std::string(mode.name);
  const double size = mode.sensor_px;
  camera.intrinsics = imported_intrinsics(parameters, mode.width_px, mode.height_px, m[2] * size, m[3] * size,
                                          m[0] * size - mode.left_px - 0.5, m[1] * size - mode.top_px - 0.5);
  camera.distortion =
      imported_distortion(parameters, "rational_polynomial", {m[4], m[5], m[13], m[12], m[6], m[7], m[8], m[9]});
  return {camera};
}

}  // namespace depthgrid::program
