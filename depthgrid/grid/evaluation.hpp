// How distances are evaluated on the depth grid: the letter's section VI, literally or with its errors mended.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/repulsion_law.hpp"
#include "depthgrid/memory/settings.hpp"

namespace depthgrid::grid {

enum class Variant : std::uint8_t {
  letter,     ///< what is printed, errors included
  corrected,  ///< never over-estimates the distance to what no camera has seen free
};

/// Which pixels of the principal camera are evaluated.
enum class Window : std::uint8_t {
  region_of_surveillance,  ///< equations (8)-(9) in `letter`, the exact window of the rho-sphere in `corrected`
  whole_image,
};

/// What is collected.
enum class Collect : std::uint8_t {
  minimum,  ///< the nearest obstacle only, by the scan that shrinks with the best distance so far
  hybrid,   ///< equation (11): distance of the nearest, direction from all obstacles within rho
};

/// Space outside the grid (the principal camera's frustum between d_min and d_max).
enum class OutsideSpace : std::uint8_t {
  ignored,   ///< obstacles outside are not reported; a point outside has no distance (state outside)
  obstacle,  ///< it counts as obstacle: D = min(D, distance to the border), 0 for a point outside
};

/// What becomes of the robot's own pixels.
enum class RobotPixels : std::uint8_t {
  case_iv,  ///< the letter's case (iv): what is behind the robot is asked of the other cameras, and an obstacle without
  removed,  ///< taken out of the image, as the letter does with a single camera: nothing behind the robot is seen
};

/// A memory of what may be where (docs/memory.md): a cell counts as obstacle only if, beyond that no camera frees it
/// now, something may be in it by what was seen before. It looks at each image as the search does, camera by camera.
struct GridMemory {
  memory::MemorySettings settings;     ///< its region is a box along the world's axes, not the principal camera's
  std::vector<CameraMargins> margins;  ///< one a camera, in the rig's order
  double v_max_m_s = std::numeric_limits<double>::quiet_NaN();  ///< fastest obstacle; has to be set
};

struct EvaluationSettings {
  Variant variant = Variant::corrected;
  Window window = Window::region_of_surveillance;
  Collect collect = Collect::minimum;
  OutsideSpace outside = OutsideSpace::ignored;
  RobotPixels robot_pixels = RobotPixels::case_iv;
  double rho_m = kDefaultRho;  ///< surveillance radius
  SensorMargin sensor;         ///< corrected only; one for all cameras: take the worst
  PoseMargin pose;             ///< corrected only; one for all cameras: take the worst
  double direction_blend =
      kDefaultBlend;  ///< b in [0, 1]: weight of the other obstacles in corrected's hybrid direction
  double repulsion_alpha = kDefaultAlpha;  ///< shape of the repulsion that weights them
  double max_frame_age_s =
      1e9;  ///< a frame older than the newest by more than this, or without a
            ///< finite time, makes answers stale; all cameras frozen together is for the caller to see
  /// By the clock: when an image is older than this at the time that evaluate() is asked for, distance_now_m is NaN.
  /// Greater than 0, at most an hour.
  double max_image_age_s = 0.5;
  /// `corrected` only. Nothing: no memory.
  std::optional<GridMemory> memory{};
};

/// Throws Error with value and rule.
void validate(const EvaluationSettings& settings);

/// Work done, for figures.
struct EvaluationCount {
  std::int64_t pixels = 0;       ///< principal pixels visited
  std::int64_t cells = 0;        ///< cells checked with the secondary cameras
  std::int64_t gray_pixels = 0;  ///< pixels in case (iii) or (iv): their distance depends on the other cameras
};

}  // namespace depthgrid::grid
