#include "depthgrid/messages/camera_info.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::messages {
namespace {

void require_form(std::span<const double> matrix, const char* name, std::initializer_list<std::size_t> zeros,
                  std::size_t one, const char* form) {
  for (const std::size_t i : zeros) {
    if (matrix[i] != 0) {
      fail("camera_info: ", name, "[", i, "] is ", matrix[i], ", must be 0: rows ", form);
    }
  }
  if (matrix[one] != 1) {
    fail("camera_info: ", name, "[", one, "] is ", matrix[one], ", must be 1: rows ", form);
  }
}

void refuse_part_of_the_sensor(const CameraInfo& info) {
  if (info.binning_x > 1 || info.binning_y > 1) {
    fail("camera_info: binning is ", info.binning_x, " x ", info.binning_y,
         ", the calibration is for the whole sensor; give a rig file for the binned images");
  }
  if (info.roi.x_offset != 0 || info.roi.y_offset != 0) {
    fail("camera_info: roi begins at ", info.roi.x_offset, ", ", info.roi.y_offset,
         ", images are a part of the sensor's; give a rig file for that part");
  }
}

PinholeCamera intrinsics(const CameraInfo& info, double fx, double fy, double cx, double cy) {
  const auto largest = static_cast<std::uint32_t>(kLargestImageSide);
  if (info.width > largest || info.height > largest) {
    fail("camera_info: is for ", info.width, " x ", info.height, " pixels, a side must be at most ", largest);
  }
  try {
    return from_opencv(static_cast<int>(info.width), static_cast<int>(info.height), fx, fy, cx, cy);
  } catch (const Error& error) {
    fail("camera_info: ", error.what());
  }
}

}  // namespace

/// Rectified images of a stereo pair lie in a frame that is turned by R and shifted by P's last column from the one
/// that the header names, and poses are of that one.
void refuse_another_frame(const CameraInfo& info) {
  const bool is_unset = std::all_of(info.r.begin(), info.r.end(), [](double value) { return value == 0; });
  for (std::size_t n = 0; n < info.r.size(); ++n) {
    constexpr double kTurn = 1e-9;
    if (!is_unset && !(std::abs(info.r[n] - (n % 4 == 0 ? 1 : 0)) <= kTurn)) {
      fail("camera_info: R turns the rectified image out of its frame, must be the identity; give a rig file");
    }
  }
  if (info.p[3] != 0 || info.p[7] != 0) {
    fail("camera_info: P shifts the rectified image out of its frame (Tx ", info.p[3], ", Ty ", info.p[7],
         "), must be 0; give a rig file");
  }
}

CameraModel camera_model(const CameraInfo& info, bool rectified) {
  refuse_part_of_the_sensor(info);
  const auto is_zero = [](double value) { return value == 0; };
  if (std::all_of(info.k.begin(), info.k.end(), is_zero)) {
    fail("camera_info: K is all 0: the camera is not calibrated; give a rig file");
  }
  if (rectified) {
    refuse_another_frame(info);
    require_form(info.p, "P", {1, 4, 8, 9}, 10, "fx 0 cx Tx, 0 fy cy Ty, 0 0 1 0");
    return {.intrinsics = intrinsics(info, info.p[0], info.p[5], info.p[2], info.p[6]), .distortion = {}};
  }
  require_form(info.k, "K", {1, 3, 6, 7}, 8, "fx 0 cx, 0 fy cy, 0 0 1");
  // Drivers that name no model mean plumb_bob.
  const auto model = distortion_model(info.distortion_model.empty() ? "plumb_bob" : info.distortion_model);
  if (!model) {
    fail("camera_info: distortion_model is '", printable_excerpt(info.distortion_model),
         "', must be plumb_bob, rational_polynomial or equidistant");
  }
  CameraModel camera{.intrinsics = intrinsics(info, info.k[0], info.k[4], info.k[2], info.k[5]), .distortion = {}};
  if (!std::all_of(info.d.begin(), info.d.end(), is_zero) || *model == Distortion::Model::equidistant) {
    try {
      camera.distortion = make_distortion(*model, info.d);
    } catch (const Error& error) {
      fail("camera_info: D: ", error.what());
    }
  }
  return camera;
}

CameraInfo camera_info(const CameraModel& camera, Header header) {
  const PinholeCamera& c = camera.intrinsics;
  const Eigen::Vector2d centre = principal_point_opencv(c);
  CameraInfo info;
  info.header = std::move(header);
  info.width = static_cast<std::uint32_t>(c.width_px);
  info.height = static_cast<std::uint32_t>(c.height_px);
  info.k = {c.fx_px, 0, centre.x(), 0, c.fy_px, centre.y(), 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {c.fx_px, 0, centre.x(), 0, 0, c.fy_px, centre.y(), 0, 0, 0, 1, 0};
  const std::span<const double> d(camera.distortion.coefficients);
  switch (camera.distortion.model) {
    case Distortion::Model::rational:
      info.distortion_model = "rational_polynomial";
      info.d.assign(d.begin(), d.end());
      break;
    case Distortion::Model::equidistant:
      info.distortion_model = "equidistant";
      info.d.assign(d.begin(), d.begin() + 4);
      break;
    default:
      info.distortion_model = "plumb_bob";
      info.d.assign(d.begin(), d.begin() + 5);  // zeros where there is none
  }
  return info;
}

}  // namespace depthgrid::messages
