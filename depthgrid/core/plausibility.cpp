#include "depthgrid/core/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/radial_distortion.hpp"

namespace depthgrid {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

struct ImageSide {
  const char* focal;   ///< "fx"
  const char* centre;  ///< "cx"
  const char* size;    ///< "width"
  double focal_px, centre_px;
  int size_px;
};

void check_field_of_view(const ImageSide& side, bool equidistant, const char* name) {
  constexpr double kNarrowest = 2.0;
  const double widest = equidistant ? 270.0 : 175.0;
  const double half = 0.5 * side.size_px / side.focal_px;
  const double degrees = 2.0 * kDegrees * (equidistant ? half : std::atan(half));
  if (degrees >= kNarrowest && degrees <= widest) {
    return;
  }
  std::ostringstream hint;
  hint.precision(4);
  if (degrees < kNarrowest) {
    hint << "; is it of a larger image, or the " << side.size << " of a smaller one?";
  } else if (side.focal_px > 0.2 && side.focal_px < 3.0) {
    hint << "; is it divided by the " << side.size << "? did you mean " << side.focal_px * side.size_px
         << " (or is it the lens's focal length in millimetres? needed are pixels)";
  } else {
    hint << "; is it in millimetres or metres? needed are pixels, usually 0.4 to 2 times the " << side.size;
  }
  fail(name, ": ", side.focal, " is ", side.focal_px, " px in an image of ", side.size, " ", side.size_px,
       " px, a field of view of ", degrees, " degrees, must be ", kNarrowest, " to ", widest, hint.str());
}

/// `opencv_px`: as people write it, from the centre of the first pixel.
void check_centre(const ImageSide& side, const char* name) {
  const double opencv_px = side.centre_px - 0.5;
  if (!(opencv_px >= -side.size_px && opencv_px <= 2.0 * side.size_px)) {
    fail(name, ": ", side.centre, " is ", opencv_px, " px in an image of ", side.size, " ", side.size_px,
         " px, must be within one ", side.size, " of the image; is the calibration for another image size? (half the ",
         side.size, " would be ", 0.5 * (side.size_px - 1), ")");
  }
}

/// Divided by the image's size, both are below 1.
void check_not_normalised(const ImageSide& x, const ImageSide& y, const char* name) {
  constexpr int kSmallest = 16;  // below that a principal point may well lie there
  const auto first_pixel = [](const ImageSide& side) {
    return side.size_px > kSmallest && std::abs(side.centre_px - 0.5) <= 1.0;
  };
  if (first_pixel(x) && first_pixel(y)) {
    fail(name, ": cx, cy is ", x.centre_px - 0.5, ", ", y.centre_px - 0.5,
         " px, the corner of the image; are they divided by the image's size, or left out? did you mean about ",
         0.5 * (x.size_px - 1), ", ", 0.5 * (y.size_px - 1), "?");
  }
}

/// The lens's image has to cover a good part of the picture, or the coefficients belong to something else.
void check_lens(const PinholeCamera& camera, const Distortion& lens, const char* name) {
  if (!distorts(lens)) {
    return;
  }
  constexpr double kSmallestShare = 0.5;  // of the way from the image's middle to its nearer border
  constexpr double kLargestTangential = 0.5;
  const auto [p1, p2] = tangential(lens);
  if (std::max(std::abs(p1), std::abs(p2)) > kLargestTangential) {
    fail(name, ": distortion: p1, p2 is ", p1, ", ", p2, ", must be at most ", kLargestTangential,
         " to either side; the order is k1 k2 p1 p2 k3 ..., are they k3 and k4?");
  }
  const double corner = square(camera.width_px / camera.fx_px) + square(camera.height_px / camera.fy_px);
  const double s = unfolded_squared_radius(lens, corner);  // far beyond the image: half of the sides would reach it
  const double reached = std::sqrt(s) * radial(lens, s).factor;
  const double middle = 0.5 * std::min(camera.width_px / camera.fx_px, camera.height_px / camera.fy_px);
  if (!(reached >= kSmallestShare * middle)) {
    fail(name, ": distortion: the coefficients fold back ", std::lround(reached * camera.fx_px),
         " px from the principal point, in an image of ", camera.width_px, " x ", camera.height_px,
         " px; are they in another order, of another model, or for another image size?");
  }
  // And by less than that it narrows what the image shows, with coefficients that grow the other way.
  constexpr double kLeastView = 1.0 / 3;  // of the tangent at the nearer border
  const double shown = kLeastView * middle;
  if (radial(lens, square(shown)).factor > 1 / kLeastView) {
    fail(name, ": distortion: by the coefficients the image's border shows less than ",
         std::atan(shown) * 180 / std::numbers::pi, " degrees off the axis, by the focal length alone ",
         std::atan(middle) * 180 / std::numbers::pi,
         "; are they in another order, of another model, or for another image size?");
  }
}

void check_at_most(const char* name, const char* what, double value, double largest, const char* unit,
                   const char* mistaken, double factor) {
  if (value > largest) {
    fail(name, ": ", what, " is ", value, unit, ", must be at most ", largest, unit, "; ", mistaken, " did you mean ",
         value * factor, "?");
  }
}

constexpr const char* kMillimetres = "in millimetres?";
constexpr const char* kMilliseconds = "in milliseconds?";

}  // namespace

void check_plausible_scale(double metres_per_unit, const char* name) {
  if (metres_per_unit >= kSmallestMetresPerUnit && metres_per_unit <= kLargestMetresPerUnit) {
    return;
  }
  const double inverse = 1.0 / metres_per_unit;
  const bool inverted = inverse >= kSmallestMetresPerUnit && inverse <= kLargestMetresPerUnit;
  fail(name, ": metres_per_unit is ", metres_per_unit, ", must be between ", kSmallestMetresPerUnit, " and ",
       kLargestMetresPerUnit, "; did you mean ", inverted ? inverse : 0.001,
       inverted ? " (metres of one unit, not units of one metre)?" : " (images in millimetres)?");
}

void check_plausible(const PinholeCamera& camera, const Distortion& lens, const char* name) {
  const ImageSide x{"fx", "cx", "width", camera.fx_px, camera.cx_px, camera.width_px};
  const ImageSide y{"fy", "cy", "height", camera.fy_px, camera.cy_px, camera.height_px};
  constexpr double kLargestRatio = 3.0;
  for (const ImageSide& side : {x, y}) {
    check_field_of_view(side, lens.model == Distortion::Model::equidistant, name);
    check_centre(side, name);
  }
  check_not_normalised(x, y, name);
  if (const double ratio = camera.fx_px / camera.fy_px; ratio > kLargestRatio || ratio < 1.0 / kLargestRatio) {
    fail(name, ": fx is ", camera.fx_px, " px and fy is ", camera.fy_px, " px, must be within a factor of ",
         kLargestRatio, "; pixels are nearly square, is one of them for another size?");
  }
  check_lens(camera, lens, name);
  try {
    refuse_fold(camera, lens);
  } catch (const Error& error) {
    fail(name, ": ", error.what());
  }
}

void check_plausible(const MeasurementRule& rule, const char* name) {
  constexpr double kLargestNear = 10.0;
  constexpr double kSmallestFar = 0.05;
  constexpr double kLargestFar = 500.0;
  check_at_most(name, "near", rule.near_m, kLargestNear, " m", kMillimetres, 1e-3);
  if (std::isfinite(rule.far_m)) {
    check_at_most(name, "far", rule.far_m, kLargestFar, " m", kMillimetres, 1e-3);
    if (rule.far_m < kSmallestFar) {
      fail(name, ": far is ", rule.far_m, " m, must be at least ", kSmallestFar, " m; in kilometres?");
    }
  }
}

void check_plausible(const CameraMargins& margins, const char* name) {
  check_at_most(name, "constant", margins.sensor.constant_m, 1.0, " m", kMillimetres, 1e-3);
  check_at_most(name, "linear", margins.sensor.linear, 1.0, "", "in percent?", 1e-2);
  check_at_most(name, "quadratic", margins.sensor.quadratic_per_m, 1.0, " 1/m", "for depths in millimetres?", 1e-3);
  check_at_most(name, "translation", margins.translation_m, 1.0, " m", kMillimetres, 1e-3);
  check_at_most(name, "rotation", margins.rotation_rad, 0.5, " rad", "in degrees?", 1.0 / kDegrees);
  check_at_most(name, "half exposure", margins.half_exposure_s, 1.0, " s", kMilliseconds, 1e-3);
  check_at_most(name, "time uncertainty", margins.time_uncertainty_s, 60.0, " s", kMilliseconds, 1e-3);
  check_at_most(name, "distance of the second view", std::abs(margins.second_view_x_m), 1.0, " m", kMillimetres, 1e-3);
  check_at_most(name, "smallest obstacle", margins.smallest_obstacle_m, 0.5, " m", kMillimetres, 1e-3);
}

void check_plausible(const Pose& pose, const char* name) {
  constexpr double kFarthest_m = 100.0;
  const Eigen::Vector3d t = pose.translation();
  if (!(t.cwiseAbs().maxCoeff() <= kFarthest_m)) {
    const Eigen::Vector3d metres = 1e-3 * t;
    fail(name, ": translation is (", t.x(), ", ", t.y(), ", ", t.z(), ") m, no coordinate may be beyond ", kFarthest_m,
         " m; in millimetres? did you mean (", metres.x(), ", ", metres.y(), ", ", metres.z(),
         ")? if not, move the world's origin near the cameras");
  }
}

void check_plausible_distances(std::span<const Pose> T_world_camera) {
  constexpr double kFarthest_m = 50.0;
  for (std::size_t k = 0; k < T_world_camera.size(); ++k) {
    double nearest_m = std::numeric_limits<double>::infinity();
    std::size_t nearest = k;
    for (std::size_t other = 0; other < T_world_camera.size(); ++other) {
      const double distance_m = (T_world_camera[other].translation() - T_world_camera[k].translation()).norm();
      if (other != k && distance_m < nearest_m) {
        nearest_m = distance_m;
        nearest = other;
      }
    }
    if (nearest != k && !(nearest_m <= kFarthest_m)) {
      fail("camera ", k, " stands ", nearest_m, " m from the nearest other one (", nearest, "), must be at most ",
           kFarthest_m, " m; are the poses in millimetres? did you mean ", 1e-3 * nearest_m, " m?");
    }
  }
}

}  // namespace depthgrid
