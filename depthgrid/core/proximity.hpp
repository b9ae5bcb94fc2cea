// The answer: how far a point is from what the cameras see and from what they cannot see.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace depthgrid {

/// What stands at the nearest point. Never encoded in the distance.
enum class ProximityState : std::uint8_t {
  not_evaluated,  ///< nobody asked yet, or the point is not finite: distance is NaN
  measured,       ///< a camera measured a surface there
  occluded,       ///< behind a measured surface for a camera that looks there, seen free by none (the gray area)
  unmeasured,     ///< some camera looks there but has no measurement (invalid pixel, blind zone)
  unobserved,     ///< no camera looks there
  outside,        ///< the space outside the space of interest: its border is nearest where that space counts as
                  ///< obstacle; where it is ignored the point itself lies outside and has no distance (NaN)
  beyond_rho,     ///< nothing within rho: distance is rho, a lower bound; there is no nearest point
};

/// Why a camera that looks at a place says nothing of it: the first that holds for any camera.
enum class Unmeasured : std::uint8_t {
  not_told,    ///< the state is another one
  no_reading,  ///< pixels without a reading there, or beside it as far as the filter or the camera's errors reach
  image_edge,  ///< so near the image's edge that the filter or the camera's errors leave it
  blind_zone,  ///< nearer to the camera than it measures
  late_image,  ///< the camera's image is too old
};

/// Of two cameras' reasons the one that comes first; the other where one is not told.
[[nodiscard]] constexpr Unmeasured first_of(Unmeasured a, Unmeasured b) noexcept {
  return a == Unmeasured::not_told ? b : b == Unmeasured::not_told || a < b ? a : b;
}

/// The state's name as it stands in CSV and JSON, for instance "beyond_rho".
[[nodiscard]] std::string_view to_string(ProximityState state) noexcept;
[[nodiscard]] std::string_view to_string(Unmeasured why) noexcept;

/// Distance from a point to the nearest obstacle: metres, world frame.
struct Proximity {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  /// Metres, >= 0. rho at beyond_rho; NaN at not_evaluated, and at outside where outside space is ignored.
  double distance_m = kNaN;
  /// The obstacle's nearest point; NaN where there is none.
  Eigen::Vector3d nearest_world = Eigen::Vector3d::Constant(kNaN);
  /// Unit vector from the point to the obstacle (equation (10)); a repulsion needs the opposite sign. Zero when the
  /// point lies in the obstacle, NaN where there is no nearest point.
  Eigen::Vector3d direction_world = Eigen::Vector3d::Constant(kNaN);
  ProximityState state = ProximityState::not_evaluated;
  /// The camera that measured the nearest point (index in the rig); only at `measured`.
  std::optional<std::uint16_t> camera;
  /// Only at `unmeasured`.
  Unmeasured unmeasured = Unmeasured::not_told;
  /// Distance from the point to the border of the space of interest where the space outside is ignored: obstacles
  /// farther away than this may be missing from the answer. NaN where it does not apply.
  double known_to_m = kNaN;
  bool stale = false;   ///< a frame behind this answer is older than the newest by more than allowed, or has no time
  bool budget = false;  ///< the evaluation stopped early: distance_m is a valid lower bound, not the
                        ///< distance. The grid evaluators always finish, so they never set it
};

/// True when distance_m is a number.
[[nodiscard]] bool has_distance(const Proximity& answer) noexcept;

/// The bound on the distance `elapsed_s` seconds after the exposure when obstacles move at most at `v_max_m_s`:
/// max(0, min(D, known_to) - v_max t), since something may stand at the border of the space of interest. NaN where the
/// answer has no distance or elapsed_s is negative or NaN.
[[nodiscard]] double lower_bound_after(const Proximity& answer, double elapsed_s, double v_max_m_s) noexcept;

}  // namespace depthgrid
