// Numbers that no depth camera has: almost always a unit that was mistaken. Each check throws Error with the value, the
// range and what was probably meant. They are wider than anything that was seen, and say nothing about what is right.
#pragma once

#include <span>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/distortion.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid {

/// Largest accepted metres of one unit of a 16-bit image, which then reaches 655 m. Most tools name the inverse (1000,
/// 5000), which would put every reading kilometres away and free everything.
inline constexpr double kLargestMetresPerUnit = 0.01;
/// Smallest: an image that reaches 65 mm.
inline constexpr double kSmallestMetresPerUnit = 1e-6;

/// Throws Error where the scale lies outside of these two. `name` is used in messages only, here and below.
void check_plausible_scale(double metres_per_unit, const char* name = "depth image");

/// A field of view of 2 to 175 degrees in both directions (equidistant: 2 to 270), pixels at most 3 times as wide as
/// high or the reverse, a principal point at most one image beside the image and not in its first pixel, which is how
/// numbers divided by the size look. Coefficients of which the lens's image covers at least the middle of the picture.
void check_plausible(const PinholeCamera& camera, const Distortion& lens, const char* name = "camera");

/// near at most 10 m, a finite far between 0.05 and 500 m.
void check_plausible(const MeasurementRule& rule, const char* name = "depth range");

/// Lengths in metres, angles in radians, times in seconds: translation and constant at most 1 m, linear and quadratic
/// at most 1, rotation at most 0.5 rad, half the exposure at most 1 s, the time stamp's error at most 60 s, the
/// smallest obstacle at most 0.5 m, the second view's distance 1 m.
void check_plausible(const CameraMargins& margins, const char* name = "margins");

/// No coordinate beyond 100 m.
void check_plausible(const Pose& pose, const char* name = "pose");

/// Cameras of one rig: each has another one within 50 m. Messages name them by number, from 0.
void check_plausible_distances(std::span<const Pose> T_world_camera);

}  // namespace depthgrid
