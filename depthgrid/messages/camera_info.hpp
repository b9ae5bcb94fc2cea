// sensor_msgs/msg/CameraInfo: a camera's calibration, in OpenCV's convention of pixels.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/distortion.hpp"
#include "depthgrid/messages/standard.hpp"

namespace depthgrid::messages {

/// sensor_msgs/msg/RegionOfInterest: which part of the sensor images hold.
struct RegionOfInterest {
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;
};

/// Matrices are row-major.
struct CameraInfo {
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0;
  std::uint32_t binning_y = 0;
  RegionOfInterest roi;
};

/// A camera as the library knows it: the principal point counts from the edge of the first pixel.
struct CameraModel {
  PinholeCamera intrinsics;
  Distortion distortion;
};

/// What the calibration says of images as the sensor has them (K and D), or of `rectified` ones (P, without
/// distortion). Throws Error with the value and the rule: no calibration (all 0), matrices of another form, a
/// distortion that is not known, images that are binned or a part of the sensor.
[[nodiscard]] CameraModel camera_model(const CameraInfo& info, bool rectified);

/// The message of such a camera. P is K, as for one camera whose rectified image keeps the focal lengths.
[[nodiscard]] CameraInfo camera_info(const CameraModel& camera, Header header);

}  // namespace depthgrid::messages
