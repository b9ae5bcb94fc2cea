// ROS sensor_msgs/CameraInfo: the file that camera_calibration writes, or a message as `ros2 topic echo` prints it.
#include "depthgrid/core/error.hpp"
#include "program/rig/formats.hpp"

namespace depthgrid::program {

namespace {

/// A matrix under either name: {rows, cols, data} in files, a list in messages.
YamlValue matrix(const YamlValue& file, const char* in_file, const char* upper, const char* lower) {
  if (file.has(in_file)) {
    const YamlValue value = file.at(in_file);
    return value.is_map() ? value.at("data") : value;
  }
  return file.at(file.has(upper) ? upper : lower);
}

bool has_matrix(const YamlValue& file, const char* in_file, const char* upper, const char* lower) {
  return file.has(in_file) || file.has(upper) || file.has(lower);
}

/// Which pixels of the sensor a message's image holds.
void refuse_part_of_the_sensor(const YamlValue& file) {
  for (const char* key : {"binning_x", "binning_y"}) {
    if (file.has(key) && file.at(key).number() > 1) {
      fail(file.at(key).context(),
           "images are binned, the calibration is for the whole sensor; give the one for the "
           "binned images");
    }
  }
  if (!file.has("roi")) {
    return;
  }
  const YamlValue roi = file.at("roi");
  for (const char* key : {"x_offset", "y_offset"}) {
    if (roi.has(key) && roi.at(key).number() != 0) {
      fail(roi.at(key).context(), "images are a part of the sensor's; give the calibration of that part");
    }
  }
}

std::string id_of(const YamlValue& file, const std::string& stem) {
  std::string id = file.has("camera_name") ? file.at("camera_name").text() : std::string();
  if (id.empty() && file.has("header") && file.at("header").has("frame_id")) {
    id = file.at("header").at("frame_id").text();
  }
  return id.empty() ? stem : id;
}

}  // namespace

std::vector<ImportedCamera> of_camera_info(const YamlValue& file, const std::string& stem,
                                           const ImportOptions& options) {
  refuse_part_of_the_sensor(file);
  const int width_px = file.at(file.has("image_width") ? "image_width" : "width").whole_number(1, kLargestImageSide);
  const int height_px =
      file.at(file.has("image_height") ? "image_height" : "height").whole_number(1, kLargestImageSide);
  ImportedCamera camera;
  camera.id = id_of(file, stem);
  camera.format = "ROS camera_info";
  if (options.rectified) {
    const YamlValue place = matrix(file, "projection_matrix", "P", "p");
    const std::vector<double> p = place.numbers(12);
    check_zeros_and_one(place, p, {1, 4, 8, 9}, 10, "must be rows fx 0 cx Tx, 0 fy cy Ty, 0 0 1 0; are these columns?");
    camera.intrinsics = imported_intrinsics(file, width_px, height_px, p[0], p[5], p[2], p[6]);
    return {camera};
  }
  const YamlValue place = matrix(file, "camera_matrix", "K", "k");
  const std::vector<double> k = place.numbers(9);
  check_zeros_and_one(place, k, {1, 3, 6, 7}, 8, "must be rows fx 0 cx, 0 fy cy, 0 0 1; are these columns?");
  camera.intrinsics = imported_intrinsics(file, width_px, height_px, k[0], k[4], k[2], k[5]);
  std::vector<double> d;
  if (has_matrix(file, "distortion_coefficients", "D", "d")) {
    d = matrix(file, "distortion_coefficients", "D", "d").numbers(0);
  }
  // Old files name no model; then it is plumb_bob.
  const bool named = file.has("distortion_model") && !file.at("distortion_model").text().empty();
  camera.distortion = imported_distortion(file, named ? file.at("distortion_model").text() : "plumb_bob", d);
  return {camera};
}

}  // namespace depthgrid::program
