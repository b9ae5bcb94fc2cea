// Open3D: PinholeCameraIntrinsic (also with the metadata of an Azure Kinect recording), PinholeCameraParameters and
// PinholeCameraTrajectory. Matrices are lists of columns.
#include "program/rig/formats.hpp"

namespace depthgrid::program {

namespace {

ImportedCamera of_intrinsic(const YamlValue& value, const std::string& id) {
  const YamlValue matrix = value.at("intrinsic_matrix");
  const std::vector<double> k = matrix.numbers(9);  // columns
  check_zeros_and_one(matrix, k, {1, 2, 3, 5}, 8, "must be columns fx 0 0, 0 fy 0, cx cy 1; are these rows?");
  ImportedCamera camera;
  camera.id = id;
  camera.format = "Open3D";
  camera.intrinsics =
      imported_intrinsics(value, value.at("width").whole_number(1, kLargestImageSide),
                          value.at("height").whole_number(1, kLargestImageSide), k[0], k[4], k[6], k[7]);
  return camera;
}

ImportedCamera of_parameters(const YamlValue& value, const std::string& id) {
  ImportedCamera camera = of_intrinsic(value.at("intrinsic"), id);
  const std::vector<double> columns = value.at("extrinsic").numbers(16);
  std::vector<double> rows(16);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      rows[4 * row + column] = columns[4 * column + row];
    }
  }
  camera.T_world_camera = imported_pose(value.at("extrinsic"), rows).inverse();  // world to camera in the file
  return camera;
}

}  // namespace

std::vector<ImportedCamera> of_open3d(const YamlValue& file, const std::string& stem) {
  if (file.has("intrinsic_matrix")) {
    return {of_intrinsic(file, stem)};
  }
  if (file.has("intrinsic")) {
    return {of_parameters(file, stem)};
  }
  std::vector<ImportedCamera> cameras;
  for (const YamlValue& parameters : file.at("parameters").elements()) {
    cameras.push_back(of_parameters(parameters, stem + std::to_string(cameras.size())));
  }
  return cameras;
}

}  // namespace depthgrid::program
