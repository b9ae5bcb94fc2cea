// Kalibr's camchain.yaml: cam0, cam1, ..., each with its place relative to the one before.
#include "depthgrid/core/error.hpp"
#include "program/rig/formats.hpp"

namespace depthgrid::program {

std::vector<ImportedCamera> of_kalibr(const YamlValue& file) {
  constexpr int kMostCameras = 1000;
  std::vector<ImportedCamera> cameras;
  for (int k = 0; k < kMostCameras; ++k) {
    const std::string key = "cam" + std::to_string(k);
    if (!file.has(key.c_str())) {
      break;
    }
    const YamlValue entry = file.at(key.c_str());
    if (const std::string model = entry.at("camera_model").text(); model != "pinhole") {
      fail(entry.at("camera_model").context(), "'", model,
           "' is not read, must be pinhole; calibrate with pinhole-equi (wide lenses) or pinhole-radtan");
    }
    const std::vector<double> i = entry.at("intrinsics").numbers(4);
    const std::vector<YamlValue> size = entry.at("resolution").elements();
    if (size.size() != 2) {
      fail(entry.at("resolution").context(), "has ", size.size(), " numbers, must have 2");
    }
    ImportedCamera camera;
    camera.id = key;
    camera.format = "Kalibr camchain";
    camera.intrinsics = imported_intrinsics(entry.at("intrinsics"), size[0].whole_number(1, kLargestImageSide),
                                            size[1].whole_number(1, kLargestImageSide), i[0], i[1], i[2], i[3]);
    const bool has_model = entry.has("distortion_model");
    camera.distortion = imported_distortion(
        entry, has_model ? entry.at("distortion_model").text() : "none",
        entry.has("distortion_coeffs") ? entry.at("distortion_coeffs").numbers(0) : std::vector<double>());
    if (k > 0) {
      const YamlValue chain = entry.at("T_cn_cnm1");
      camera.T_previous_camera = imported_pose(chain, chain.numbers(16)).inverse();
    }
    cameras.push_back(camera);
  }
  for (int k = static_cast<int>(cameras.size()); k < kMostCameras; ++k) {
    if (const std::string key = "cam" + std::to_string(k); file.has(key.c_str())) {
      fail(file.context(), "has '", key, "' but no 'cam", cameras.size(),
           "', and the chain goes through every camera; number them cam0, cam1, ... without a gap");
    }
  }
  return cameras;
}

}  // namespace depthgrid::program
